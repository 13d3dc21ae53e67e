#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/considered.hpp"
#include "calib/result/posterior.hpp"
#include "datasets/campaign/campaign.hpp"

// A parameter after a fit.

namespace rigcal::calib {

/// Half width of an interval, relative to the value, above which a parameter is weak. It is the one
/// limit of docs/uncertainty.md for fitted, planned and combined values.
inline constexpr double kWeak = 0.2;

enum class Identifiability {
  identified,
  weak,              ///< half width of the 95 % interval above 20 % of the value
  bounded,           ///< not distinguishable from zero: only the interval is known
  not_identifiable,  ///< half width above 100 %, no interval, or an open profile
};
std::string_view to_string(Identifiability identifiability);

/// Error on which an interval is based.
enum class IntervalSource { none, standard_error, robust_standard_error };
std::string_view to_string(IntervalSource source);

/// One end of a profile: where the cost has risen to the limit of a 95 % interval.
struct ProfileEnd {
  std::optional<double> value;  ///< absent: the cost stays below up to `reached`
  double reached = 0.0;         ///< value up to which the profile was followed
  /// Abandoned: the inner fit failed or was cancelled; otherwise unbounded. Absent: not known.
  Later<std::optional<bool>> lost = std::optional(false);
  RIGCAL_DESCRIBE(value, reached, lost)

  bool is_lost() const { return lost.value_or(false); }
};

/// Profile likelihood of one unknown: least cost of all others at fixed values of this one.
struct Profile {
  ProfileEnd low, high;
  std::vector<double> values;  ///< SI, ascending
  std::vector<double> rises;   ///< rises of 2 cost, in units of the threshold: 1 ends the interval
  bool lower_cost_found = false;  ///< the fit was not at the minimum; not in results
  RIGCAL_DESCRIBE(low, high, values, rises)
};

/// One parameter over bootstrap replicates.
struct BootstrapSpread {
  double standard_error = 0.0;
  double bias = 0.0;          ///< mean of the replicates minus the estimate
  double freedom = 0.0;       ///< degrees of freedom of the standard error
  std::optional<Range> ci95;  ///< percentiles, widened for the degrees of freedom
  RIGCAL_DESCRIBE(standard_error, bias, freedom, ci95)
};

/// An estimate over several models, each with its weight.
struct AveragedEstimate {
  double value = 0.0;           ///< SI
  double standard_error = 0.0;  ///< error within each model, and scatter between them, SI
  RIGCAL_DESCRIBE(value, standard_error)
};

/// One parameter in the result: fitted or known.
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
  bool correlated = true;  ///< where it has an error, it has a row in the matrix of correlations
  std::optional<double> standard_error;  ///< absent where the Jacobian does not determine it
  /// From the residuals themselves: larger if they are correlated in time.
  std::optional<double> robust_standard_error;
  /// Interval of the rig: includes what the model leaves out, where that was considered.
  std::optional<Range> ci95;
  /// What it would be if the model were exact.
  std::optional<Range> ci95_if_exact;
  IntervalSource interval = IntervalSource::none;  ///< basis of ci95_if_exact
  /// With which the error that ci95_if_exact rests on is known; at most metrics::kManyDegrees.
  std::optional<double> degrees_of_freedom;
  /// Standard error by what differs between days, in no interval: it counts where estimates of
  /// different dates are compared.
  std::optional<double> between_days_error;
  std::optional<Budget95> budget;  ///< contributions to ci95; absent where nothing was considered
  /// Over the fits with the effects that the residuals ask for; absent where they ask for none.
  std::optional<AveragedEstimate> averaged;
  /// The most that an effect which the residuals ask for would move the estimate, SI.
  double moved_by_missing = 0.0;
  /// The most that a significant error of the model which no effect explains could, SI.
  double moved_by_unexplained = 0.0;
  std::optional<BootstrapSpread> bootstrap;
  std::optional<Profile> profile;
  std::optional<PosteriorSpread> posterior;
  bool at_bound = false;
  Identifiability identifiability = Identifiability::identified;
  std::string reason;  ///< in words: why no error, why weak, at which bound
};

/// Standard deviation of a parameter without an error, for later steps: that of a uniform
/// distribution over its interval, or over its bounds if there is none.
double undetermined_sd(const std::optional<Range>& ci95, double lower, double upper);

}  // namespace rigcal::calib
