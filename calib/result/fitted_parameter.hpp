#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/campaign/campaign.hpp"

// What is known of a parameter after a fit.

namespace rigcal::calib {

/// Half width of an interval, relative to the value, above which a parameter is weak: the one limit
/// of docs/uncertainty.md for what was fitted, planned, or fixed in a combination.
inline constexpr double kWeak = 0.2;

enum class Identifiability {
  identified,
  weak,              ///< half width of the 95 % interval above 20 % of the value
  bounded,           ///< cannot be told from zero: the interval is all that is known
  not_identifiable,  ///< half width above 100 %, no interval, or an open profile
};
std::string_view to_string(Identifiability identifiability);

/// What an interval rests on.
enum class IntervalSource { none, standard_error, robust_standard_error };
std::string_view to_string(IntervalSource source);

/// One end of a profile: where the cost has risen by what a 95 % interval allows.
struct ProfileEnd {
  std::optional<double> value;  ///< absent: the cost stays below up to `reached`
  double reached = 0.0;         ///< value up to which the profile was followed
  bool lost = false;  ///< abandoned: the inner fit failed or was cancelled; otherwise unbounded
};

/// Profile likelihood of one unknown: least cost of all others at fixed values of this one.
struct Profile {
  ProfileEnd low, high;
  std::vector<double> values;     ///< SI, ascending
  std::vector<double> rises;      ///< of 2 cost, in units of the threshold: 1 ends the interval
  bool lower_cost_found = false;  ///< the fit was not at the minimum
};

/// One parameter over bootstrap replicates.
struct BootstrapSpread {
  double standard_error = 0.0;
  double bias = 0.0;                 ///< mean of the replicates minus the estimate
  double freedom = 0.0;              ///< with which the spread is known
  std::pair<double, double> ci95{};  ///< percentiles, widened for the freedom
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
  /// From the scatter of the residuals themselves: larger where they are correlated in time.
  std::optional<double> robust_standard_error;
  std::optional<std::pair<double, double>> ci95;
  IntervalSource interval = IntervalSource::none;  ///< of ci95
  /// With which the error that ci95 rests on is known; at most metrics::kManyDegrees.
  std::optional<double> degrees_of_freedom;
  std::optional<BootstrapSpread> bootstrap;
  std::optional<Profile> profile;
  bool at_bound = false;
  Identifiability identifiability = Identifiability::identified;
  std::string reason;  ///< in words: why no error, why weak, at which bound
};

/// Standard deviation of a parameter that a fit gave no error, for who must go on with it: anywhere
/// in its interval alike, or within its bounds where there is none.
double undetermined_sd(const std::optional<std::pair<double, double>>& ci95, double lower,
                       double upper);

}  // namespace rigcal::calib
