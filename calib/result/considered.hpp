#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/posterior.hpp"
#include "calib/result/uncertainty_budget.hpp"
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
  std::vector<ConsideredEffect> effects;  ///< all that were considered, or could not be
  std::vector<std::string> left_out;      ///< keys of effects that the campaign excludes
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
  std::string key;                               ///< key of the parameter
  std::string unit;                              ///< SI unit of value, difference and expanded
  datasets::Scope scope = datasets::Scope::rig;  ///< "rig", "leak_level" or "condition"
  std::optional<std::string> level;              ///< leak level or condition; absent for the rig
  double value = 0.0;                            ///< estimate from the validation records
  double difference = 0.0;                       ///< `value` minus the estimate of the fit
  double expanded = 0.0;  ///< half-width of the 95 % interval of the difference
  bool differs = false;   ///< true if the difference is significant, adjusted for all parameters
  RIGCAL_DESCRIBE(key, unit, scope, level, value, difference, expanded, differs)
};

}  // namespace rigcal::calib
