#pragma once

#include <span>

namespace rigcal::metrics {

// Each metric compares a measured y with a simulated s, both of shape (n), with the same unit and
// sample times. Moments are population moments (divided by n), and e = y - s. All functions throw
//   std::invalid_argument  if sizes differ, n < 2, or a value is not finite
//   std::domain_error      if the metric is undefined: the measured signal is constant (all metrics
//                          except rmse and maximum_error), the simulated one is (correlation), or
//                          the result exceeds the largest double
// so that nothing undefined is ever printed as a number. Every sum is exact to about 1e-16 of the
// variation that it measures, for any offset, scale and length.

/// Coefficient of determination, eq. 15: rho2 = 1 - var(e) / var(y). Insensitive to a constant
/// offset. At most 1, no lower limit; 0 for a constant simulated signal.
double rho2(std::span<const double> measured, std::span<const double> simulated);

/// 1 - rho2 = var(e) / var(y), with full precision even if rho2 is very close to 1.
double unexplained_variance(std::span<const double> measured, std::span<const double> simulated);

/// Pearson correlation, eq. 16: R = cov(y, s) / (std(y) std(s)), in [-1, 1]. Insensitive to gain
/// and offset.
double correlation(std::span<const double> measured, std::span<const double> simulated);

/// Concordance, eq. 17: CCC = (var(s) + var(y) - var(e)) / (var(s) + var(y) + (mean e)^2), in [-1,
/// 1], computed in Lin's equivalent form 2 cov(y, s) / (var(y) + var(s) + (mean y - mean s)^2). 0
/// for a constant simulated signal.
double concordance(std::span<const double> measured, std::span<const double> simulated);

/// 100 mean |e| / (max y - min y), in percent. The paper does not define its absolute error; this
/// is our definition.
double absolute_error_percent(std::span<const double> measured, std::span<const double> simulated);

/// sqrt(mean(e^2)), in the unit of y.
double rmse(std::span<const double> measured, std::span<const double> simulated);

/// The fit that MATLAB's compare() reports: 100 (1 - ||e|| / ||y - mean y||), in percent. At most
/// 100, no lower limit.
double nrmse_fit_percent(std::span<const double> measured, std::span<const double> simulated);

/// max |e|, in the unit of y.
double maximum_error(std::span<const double> measured, std::span<const double> simulated);

/// A value for every metric in metrics/metric_table.hpp.
struct Agreement {
  double rho2 = 0.0;
  double r = 0.0;
  double ccc = 0.0;
  double absolute_error_percent = 0.0;
  double rmse = 0.0;
  double nrmse_fit_percent = 0.0;
  double maximum_error = 0.0;

  /// Visits every metric under its name in metrics/metric_table.hpp.
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit);
};

/// Computes all metrics at the cost of one, each with the same bits as if computed separately.
/// Throws if any of them does. For signals for which a metric is undefined (a constant simulation
/// has no R), compute the others separately.
Agreement agreement(std::span<const double> measured, std::span<const double> simulated);

/// Rms of a zero-mean error for which rho2 is exactly at its limit: sqrt((1 - limit) var(y)), in
/// the unit of y.
///
/// @param measured  shape (n)
/// @return          0 for n < 2, and for a limit of 1 or more
/// @throws std::invalid_argument  if a value is not finite
double allowed_rms(std::span<const double> measured, double rho2_limit);

}  // namespace rigcal::metrics
