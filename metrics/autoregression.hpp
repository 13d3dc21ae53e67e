#pragma once

#include <span>
#include <vector>

namespace rigcal::metrics {

/// Autoregressive model of a zero-mean series: x[t] = sum_k phi[k] x[t - 1 - k] + u[t], u white.
struct Autoregression {
  std::vector<double> phi;  ///< shape (order); always stationary
  double variance = 0.0;    ///< variance of u, in the square of the series' unit

  /// Number of independent samples that would determine the mean as precisely as `samples` of the
  /// series: samples * variance of a sample / long-run variance, from 1 to `samples`.
  double effective_samples(double samples) const;
};

/// Autocovariances about zero, sum_t x[t] x[t + h] / n for h = 0..lags (0 beyond the series).
std::vector<double> autocovariance(std::span<const double> series, int lags);

/// Maximum number of lags that are summed for a model. It limits the computing time if the series
/// drifts slowly.
inline constexpr int kLongestMemory = 5000;

/// Whether these values, from lag 0 on, can be the autocovariances of a series: gamma[0] > 0, and
/// all partial autocorrelations are within (-1, 1). False for a series of zeros.
bool is_autocovariance(std::span<const double> gamma);

/// Partial autocorrelations at lags 1, 2, ...: the correlation that the shorter lags leave
/// unexplained, by the Levinson-Durbin recursion. The list ends at the first value whose magnitude
/// is 1 or more; if the values are the autocovariances of a series that does not repeat exactly, it
/// has one value for each lag.
///
/// @param gamma  autocovariances or autocorrelations from lag 0 on
std::vector<double> partial_autocorrelations(std::span<const double> gamma);

/// Theoretical autocovariances of a model for lags 0..lags.
std::vector<double> autocovariance(const Autoregression& model, int lags);

/// Fits the model of order up to gamma.size() - 1 that has the lowest Bayesian information
/// criterion, n ln(variance) + order ln(n), using the Levinson-Durbin recursion (Brockwell and
/// Davis, Time Series, 1991, 5.2 and 9.2). Partial autocorrelations are limited to 1 - 10 / n, so
/// that no model has a longer memory than the series can show. Once one has been limited, the
/// recursion ends at the next one whose magnitude is 1 or more.
///
/// @param gamma    autocovariances starting at lag 0, gamma[0] >= 0; if it is 0, the result is
///                 white noise with variance 0
/// @param samples  n, length of the series, >= 1
Autoregression fit_autoregression(std::span<const double> gamma, double samples);

}  // namespace rigcal::metrics
