#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"

// What small effects that the model leaves out do to the estimates, and what the residuals say of
// them.

namespace rigcal::calib {

/// One effect that the model leaves out. Sizes and estimates in SI.
struct ConsideredEffect {
  std::string key;         ///< as [considered] calls it
  std::string meaning;     ///< in words
  std::string unit;        ///< SI unit of its size
  double size = 0.0;       ///< plausible size: standard deviation of the prior about zero
  bool one_sided = false;  ///< it cannot be negative
  std::string size_from;   ///< what the size follows from, in words
  std::optional<std::string> problem;  ///< why it could not be considered, in words
  /// By prior and records, with all other effects; absent where it was not considered.
  std::optional<double> estimate, standard_error;
  /// By the records, if it were the only effect; absent where they do not respond to it.
  std::optional<double> alone, alone_error;
  std::optional<double> alone_half_width;  ///< half width of its 95 % interval
  std::optional<double> p_value;           ///< score test of none
  std::optional<double> p_of_all;          ///< the same for all effects together (Holm)
  double explains = 0.0;  ///< by how much it alone would lower the sum of the squared residuals
  RIGCAL_DESCRIBE(key, meaning, unit, size_from, size, one_sided, problem, estimate, standard_error,
                  alone, alone_half_width, p_value, p_of_all, explains)
};

/// One contribution to the uncertainty of an estimate.
struct BudgetLine {
  /// "noise", "repeats", the key of a known value or an effect, or "nonlinearity" of the effects.
  std::string source;
  std::string kind;          ///< "records", "known_value" or "effect"
  double uncertainty = 0.0;  ///< standard uncertainty that it contributes, SI
  Omittable<double> sensitivity = {};  ///< change of the estimate per unit of an effect's size, SI
  RIGCAL_DESCRIBE(source, kind, uncertainty, sensitivity)
};

/// Uncertainty budget of an estimate (JCGM 100:2008, 5.1 and annex G): the squares of the lines add
/// up to that of the combined standard uncertainty.
struct Budget95 {
  std::vector<BudgetLine> lines;
  double combined = 0.0;            ///< standard uncertainty, SI
  double degrees_of_freedom = 0.0;  ///< effective ones of it
  double coverage_factor = 0.0;
  double expanded = 0.0;  ///< coverage factor times combined, SI
  /// By how much the effects move the middle of the interval off the estimate, which is not
  /// corrected for them, SI.
  double shift = 0.0;
  RIGCAL_DESCRIBE(lines, combined, degrees_of_freedom, coverage_factor, expanded, shift)

  /// What the lines of a kind contribute together: the root of the sum of their squares.
  double contribution(std::string_view of_kind) const;
  /// The line of an effect that contributes most; null where none does.
  const BudgetLine* largest_effect() const;
};

/// The fit made again with effects that the residuals ask for as further unknowns.
struct RefittedModel {
  std::vector<std::string> effects;  ///< keys; none: the model as it is
  std::vector<double> sizes;         ///< SI
  double fall = 0.0;                 ///< decrease of the sum of squared residuals
  /// The same for conditions that are each predicted from the others; absent with one condition.
  std::optional<double> held_out_fall;
  double weight = 0.0;  ///< weight of its estimates in the average (Akaike)
  RIGCAL_DESCRIBE(effects, sizes, fall, held_out_fall, weight)
};

/// What was considered in a fit.
struct Considered {
  std::vector<ConsideredEffect> effects;
  std::vector<std::string> left_out;  ///< by the campaign
  /// Keys of the effects that the residuals ask for, the best explanation first.
  std::vector<std::string> missing;
  Later<std::vector<RefittedModel>> refitted;  ///< empty: the residuals ask for nothing
  /// Correlations of the effects' sizes by prior and records, shape (considered ones)^2; these are
  /// the first in `effects`.
  Later<Eigen::MatrixXd> correlation;
  RIGCAL_DESCRIBE(effects, left_out, missing, refitted, correlation)

  /// The effect of a key; null where there is none.
  const ConsideredEffect* find(std::string_view key) const;
};

/// An estimate made once more from the validation records alone. SI.
struct StabilityCheck {
  std::string key;  ///< key of the parameter
  std::string unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;  ///< leak level or condition; absent: the rig
  double value = 0.0;                ///< by the validation records
  double difference = 0.0;           ///< estimate from validation records minus that of the fit
  double expanded = 0.0;             ///< half width of its 95 % interval
  bool differs = false;              ///< significantly, all parameters together
  RIGCAL_DESCRIBE(key, unit, scope, level, value, difference, expanded, differs)
};

}  // namespace rigcal::calib
