#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/considered.hpp"
#include "calib/result/posterior.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"

// A parameter after a fit.

namespace rigcal::calib {

/// Half-width of an interval, relative to the value, above which a parameter is weak. The same
/// limit applies to fitted, planned and combined values (docs/uncertainty.md).
inline constexpr double kWeak = 0.2;

enum class Identifiability {
  identified,
  weak,              ///< half-width of the 95 % interval above 20 % of the value
  bounded,           ///< cannot be distinguished from zero; only its interval is known
  not_identifiable,  ///< half-width above 100 % of the value, no interval, or an open profile
};
RIGCAL_NAMES(Identifiability, identified, weak, bounded, not_identifiable)

/// The standard error on which an interval is based.
enum class IntervalSource { none, standard_error, robust_standard_error };
std::string_view to_string(IntervalSource source);

/// One end of a profile, at which the cost has risen to the limit of a 95 % interval.
struct ProfileEnd {
  std::optional<double> value;  ///< end of the interval; absent if the cost never rises so far
  double reached = 0.0;         ///< value up to which the profile was followed
  /// Whether the profile was abandoned because an inner fit failed or was cancelled. If it was not,
  /// an end without a value is unbounded. Absent if unknown.
  Later<std::optional<bool>> lost = std::optional(false);
  RIGCAL_DESCRIBE(value, reached, lost)

  bool is_lost() const { return lost.value_or(false); }
};

/// Profile likelihood of one unknown: the cost at fixed values of this unknown, minimised over all
/// others.
struct Profile {
  ProfileEnd low, high;        ///< where the profile ends on this side
  std::vector<double> values;  ///< values of the unknown, shape (points), ascending, SI
  /// Rise in 2 cost as a fraction of the threshold, shape (points); the 95 % interval ends at 1.
  std::vector<double> rises;
  bool lower_cost_found = false;  ///< true if the fit was not at the minimum; not stored
  RIGCAL_DESCRIBE(low, high, values, rises)
};

/// Statistics of one parameter over the bootstrap replicates, in the unit of the parameter.
struct BootstrapSpread {
  double standard_error = 0.0;  ///< standard deviation of the replicates
  double bias = 0.0;            ///< mean of the replicates minus the estimate
  double freedom = 0.0;         ///< degrees of freedom of the standard error
  std::optional<Range> ci95;    ///< percentiles, widened to account for the degrees of freedom
  RIGCAL_DESCRIBE(standard_error, bias, freedom, ci95)
};

/// Weighted average of an estimate over several models.
struct AveragedEstimate {
  double value = 0.0;  ///< SI
  /// Combines the errors within the models and the variation between them, SI.
  double standard_error = 0.0;
  RIGCAL_DESCRIBE(value, standard_error)
};

/// One parameter of the result, fitted or known.
struct FittedParameter {
  int index = 0;
  datasets::Scope scope = datasets::Scope::rig;
  std::string level;  ///< leak level or condition; empty for the rig
  double value = 0.0;
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  bool fitted = false;
  bool nuisance = false;
  bool correlated = true;  ///< if true and it has an error, it has a row in the correlation matrix
  std::optional<double> standard_error;  ///< absent if the Jacobian does not determine it
  /// Computed from the residuals themselves, and therefore larger if they are correlated in time.
  std::optional<double> robust_standard_error;
  /// Interval for the real rig. It includes the effects that the model omits, if they were
  /// considered.
  std::optional<Range> ci95;
  /// Interval under the assumption that the model is exact.
  std::optional<Range> ci95_if_exact;
  IntervalSource interval = IntervalSource::none;  ///< basis of ci95_if_exact
  /// Degrees of freedom of the error that ci95_if_exact is based on; at most metrics::kManyDegrees.
  std::optional<double> degrees_of_freedom;
  /// Standard error due to quantities that differ between days. No interval includes it. It only
  /// matters when estimates from different dates are compared.
  std::optional<double> between_days_error;
  std::optional<Budget95> budget;  ///< contributions to ci95; absent if no effects were considered
  /// Average over the fits with the effects that the residuals call for. Absent if the residuals
  /// call for no effect.
  std::optional<AveragedEstimate> averaged;
  /// Largest change in the estimate due to an effect that the residuals call for, SI.
  double moved_by_missing = 0.0;
  /// Largest possible change in the estimate due to a significant model error that no effect
  /// explains, SI.
  double moved_by_unexplained = 0.0;
  std::optional<BootstrapSpread> bootstrap;
  std::optional<Profile> profile;
  std::optional<PosteriorSpread> posterior;
  bool at_bound = false;
  Identifiability identifiability = Identifiability::identified;
  std::string reason;  ///< why it has no error or is weak, or at which bound it is, in words
};

/// Returns the standard deviation that later steps assume for a parameter without an error: that of
/// a uniform distribution over its interval, or over its bounds if it has no interval.
double undetermined_sd(const std::optional<Range>& ci95, double lower, double upper);

}  // namespace rigcal::calib
