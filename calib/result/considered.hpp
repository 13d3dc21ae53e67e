#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/posterior.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"

// Small effects that the model omits: how they change the estimates, and whether the residuals show
// them.

namespace rigcal::calib {

/// One effect that the model omits. Sizes and estimates in SI.
struct ConsideredEffect {
  std::string key;         ///< key in [considered]
  std::string meaning;     ///< description in words
  std::string unit;        ///< SI unit of the size
  double size = 0.0;       ///< plausible size: standard deviation of the prior about zero
  bool one_sided = false;  ///< true if the effect cannot be negative
  std::string size_from;   ///< source of the size, in words
  std::optional<std::string> problem;  ///< why the effect could not be considered, in words
  /// Estimated from prior and records, jointly with all other effects. Absent if the effect was not
  /// considered.
  std::optional<double> estimate, standard_error;
  /// Estimated from the records under the assumption that no other effect acts. Absent if the
  /// records do not respond to the effect.
  std::optional<double> alone, alone_error;
  std::optional<double> alone_half_width;  ///< half-width of the 95 % interval of `alone`
  std::optional<double> p_value;           ///< p-value of a score test against zero size
  std::optional<double> p_of_all;          ///< p_value adjusted for all effects (Holm)
  double explains = 0.0;  ///< decrease in the sum of squared residuals if only this effect is added
  Omittable<PosteriorSpread> posterior = {};  ///< draws of its size, jointly with all unknowns
  RIGCAL_DESCRIBE(key, meaning, unit, size_from, size, one_sided, problem, estimate, standard_error,
                  alone, alone_half_width, p_value, p_of_all, explains, posterior)
};

/// One contribution to the uncertainty of an estimate.
struct BudgetLine {
  /// "noise", "repeats", the key of a known value or an effect, or "nonlinearity" (in the effects).
  std::string source;
  std::string kind;          ///< "records", "known_value" or "effect"
  double uncertainty = 0.0;  ///< contribution to the standard uncertainty of the estimate, SI
  Omittable<double> sensitivity = {};  ///< change in the estimate per unit of an effect's size, SI
  RIGCAL_DESCRIBE(source, kind, uncertainty, sensitivity)
};

/// Uncertainty budget of an estimate (JCGM 100:2008, 5.1 and annex G). The squared contributions
/// add up to the square of the combined standard uncertainty.
struct Budget95 {
  std::vector<BudgetLine> lines;
  double combined = 0.0;            ///< standard uncertainty, SI
  double degrees_of_freedom = 0.0;  ///< effective degrees of freedom of `combined`
  double coverage_factor = 0.0;
  double expanded = 0.0;  ///< `coverage_factor` times `combined`, SI
  /// Offset of the interval's centre from the estimate due to the effects, SI. The estimate itself
  /// is not corrected for them.
  double shift = 0.0;
  RIGCAL_DESCRIBE(lines, combined, degrees_of_freedom, coverage_factor, expanded, shift)

  /// Combined contribution of all lines of one kind: the root of the sum of their squares.
  double contribution(std::string_view of_kind) const;
  /// The line of the effect with the largest contribution; null if no effect contributes.
  const BudgetLine* largest_effect() const;
};

/// A repeated fit in which effects that the residuals call for are additional unknowns.
struct RefittedModel {
  std::vector<std::string> effects;  ///< keys of the added effects; empty for the unchanged model
  std::vector<double> sizes;         ///< estimated sizes of these effects, SI
  double fall = 0.0;                 ///< decrease in the sum of squared residuals
  /// Decrease in the sum of squared residuals if each condition is predicted from the others.
  /// Absent if there is only one condition.
  std::optional<double> held_out_fall;
  double weight = 0.0;  ///< Akaike weight of this model in the averaged estimates
  RIGCAL_DESCRIBE(effects, sizes, fall, held_out_fall, weight)
};

/// The small effects that a fit considered.
struct Considered {
  std::vector<ConsideredEffect> effects;
  std::vector<std::string> left_out;  ///< keys of effects that the campaign excludes
  /// Keys of the effects that the residuals call for; the one that explains them best comes first.
  std::vector<std::string> missing;
  Later<std::vector<RefittedModel>> refitted;  ///< empty if the residuals call for no effect
  /// Correlations of the effects' sizes given prior and records, shape (considered effects)^2. The
  /// considered effects come first in `effects`.
  Later<Eigen::MatrixXd> correlation;
  RIGCAL_DESCRIBE(effects, left_out, missing, refitted, correlation)

  /// Finds an effect by its key; returns null if there is none.
  const ConsideredEffect* find(std::string_view key) const;
};

/// An estimate recomputed from the validation records only. SI.
struct StabilityCheck {
  std::string key;  ///< key of the parameter
  std::string unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;  ///< leak level or condition; absent for the rig
  double value = 0.0;                ///< estimate from the validation records
  double difference = 0.0;           ///< `value` minus the estimate of the fit
  double expanded = 0.0;             ///< half-width of the 95 % interval of the difference
  bool differs = false;  ///< true if the difference is significant, adjusted for all parameters
  RIGCAL_DESCRIBE(key, unit, scope, level, value, difference, expanded, differs)
};

}  // namespace rigcal::calib
