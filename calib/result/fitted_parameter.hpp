#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/problem/parameter_map.hpp"
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
enum class IntervalSource { standard_error, robust_standard_error };
RIGCAL_NAMES(IntervalSource, standard_error, robust_standard_error)

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
  double value = 0.0;  ///< the average, SI
  /// Combines the errors within the models and the variation between them, SI.
  double standard_error = 0.0;
  RIGCAL_DESCRIBE(value, standard_error)
};

/// One parameter of the result, fitted or known. Numbers are in SI; files have null for a number
/// that is not finite.
struct FittedParameter {
  int index = 0;                                 ///< row of the plant's parameter table; not stored
  std::string name;                              ///< name in result files: "mass_kg"
  std::string key;                               ///< name in campaign files: "mass"
  std::string symbol;                            ///< symbol in the equations: "m"
  std::string unit;                              ///< SI unit: "kg"; "1" if dimensionless
  datasets::Scope scope = datasets::Scope::rig;  ///< scope of the value
  std::optional<std::string> level;              ///< leak level or condition; absent for the rig
  double value = 0.0;                            ///< the estimate, or the known value
  double start = 0.0;                  ///< where the fit began; the value itself if it is known
  std::optional<double> lower, upper;  ///< bounds of the fit; absent for a known value
  bool fitted = false;                 ///< false for a known value
  bool nuisance = false;               ///< fitted, but of no interest itself
  /// If true and it has an error, it has a row in the correlation matrix. Not stored.
  bool correlated = true;
  /// Standard error for independent residuals; absent if the Jacobian does not determine it.
  std::optional<double> standard_error;
  /// Computed from the residuals themselves, and therefore larger if they are correlated in time.
  std::optional<double> robust_standard_error;
  /// Interval for the real rig. It includes the effects that the model omits, if they were
  /// considered.
  std::optional<Range> ci95;
  /// Interval under the assumption that the model is exact.
  Later<std::optional<Range>> ci95_if_exact;
  Later<std::optional<IntervalSource>> ci95_from;  ///< basis of ci95_if_exact
  /// Degrees of freedom of the error that ci95_if_exact is based on; at most metrics::kManyDegrees.
  Later<std::optional<double>> degrees_of_freedom;
  /// Standard error due to quantities that differ between days. No interval includes it. It only
  /// matters when estimates from different dates are compared.
  Omittable<double> between_days_error;
  Omittable<Budget95> budget;  ///< contributions to ci95; absent if no effects were considered
  /// Average over the fits with the effects that the residuals call for. Absent if the residuals
  /// call for no effect.
  Omittable<AveragedEstimate> averaged;
  /// Largest change in the estimate due to an effect that the residuals call for, SI. Not stored.
  double moved_by_missing = 0.0;
  /// Largest possible change in the estimate due to a significant model error that no effect
  /// explains, SI. Not stored.
  double moved_by_unexplained = 0.0;
  /// Largest possible change in the estimate due to a model error that adequacy tolerates and that
  /// is too small to be significant, SI. Not stored.
  double moved_by_unseen = 0.0;
  Omittable<BootstrapSpread> bootstrap;            ///< absent unless requested
  Omittable<Profile> profile;                      ///< absent unless requested
  Omittable<PosteriorSpread> posterior;            ///< absent unless requested
  bool at_bound = false;                           ///< whether the estimate is at one of its bounds
  std::optional<Identifiability> identifiability;  ///< absent for a known value
  std::string reason;  ///< why it has no error or is weak, or at which bound it is, in words
  RIGCAL_DESCRIBE(name, key, symbol, unit, scope, level, value, start, lower, upper, fitted,
                  nuisance, standard_error, robust_standard_error, ci95, ci95_if_exact, ci95_from,
                  degrees_of_freedom, budget, averaged, between_days_error, bootstrap, profile,
                  posterior, at_bound, identifiability, reason)

  /// Takes name, key, symbol and unit from a row of a parameter table.
  void name_after(const model::ParameterSpec& spec);
  /// Returns true for the parameter with this row, scope and level (empty for the rig).
  bool matches(int row, datasets::Scope of, const std::string& level_of) const;
};

/// Returns the parameter in a row of a plant's table, without a value.
///
/// @param level  leak level or condition; empty for the rig
FittedParameter parameter_in_row(model::PlantKind plant, int index, datasets::Scope scope,
                                 const std::string& level);

/// Returns the standard deviation that later steps assume for a parameter without an error: that of
/// a uniform distribution over its interval, or over its bounds if it has no interval.
double undetermined_sd(const std::optional<Range>& ci95, double lower, double upper);

}  // namespace rigcal::calib
