#pragma once

#include <span>

namespace rigcal::metrics {

// Each metric of measured y and simulated s, both of shape (n), same unit, same sample times.
// Population moments (divided by n). All throw
//   std::invalid_argument  sizes differ, n < 2, or a value is not finite
//   std::domain_error      the metric does not exist: a signal is constant where its variance divides
// so that nothing undefined is ever printed as a number.

/// Coefficient of determination, eq. 15: rho2 = 1 - var(y - s) / var(y). Blind to a constant offset.
double rho2(std::span<const double> measured, std::span<const double> simulated);

/// Pearson correlation, eq. 16: R = cov(y, s) / (std(y) std(s)). Blind to gain and offset.
double correlation(std::span<const double> measured, std::span<const double> simulated);

/// Concordance, eq. 17, equal to Lin's: CCC = 2 cov(y, s) / (var(y) + var(s) + (mean y - mean s)^2).
double concordance(std::span<const double> measured, std::span<const double> simulated);

/// Mean absolute residual over the peak-to-peak of the measured signal, in percent. The paper does
/// not define its absolute error; this is our definition.
double absolute_error_percent(std::span<const double> measured, std::span<const double> simulated);

/// sqrt(mean((y - s)^2)), in the unit of y.
double rmse(std::span<const double> measured, std::span<const double> simulated);

/// MATLAB compare's fit: 100 (1 - ||y - s|| / ||y - mean y||), in percent.
double nrmse_fit_percent(std::span<const double> measured, std::span<const double> simulated);

/// max |y - s|, in the unit of y.
double maximum_error(std::span<const double> measured, std::span<const double> simulated);

/// All of the above in one pass over the data (two passes for the moments).
struct Agreement {
  double rho2 = 0.0;
  double r = 0.0;
  double ccc = 0.0;
  double absolute_error_percent = 0.0;
  double rmse = 0.0;
  double nrmse_fit_percent = 0.0;
  double maximum_error = 0.0;
};
Agreement agreement(std::span<const double> measured, std::span<const double> simulated);

}  // namespace rigcal::metrics
