#pragma once

#include <span>
#include <vector>

namespace rigcal::metrics {

/// Autoregressive model of a series about zero: x[t] = sum_k phi[k] x[t - 1 - k] + u[t], u white.
struct Autoregression {
  std::vector<double> phi;  ///< shape (order); always stationary
  double variance = 0.0;    ///< variance of u, in the square of the series' unit

  /// Number of independent samples that determine the mean as well as `samples` of the series:
  /// samples * variance of a sample / long-run variance, from 1 to `samples`.
  double effective_samples(double samples) const;
};

/// Autocovariances about zero, sum_t x[t] x[t + h] / n for h = 0..lags (0 beyond the series).
std::vector<double> autocovariance(std::span<const double> series, int lags);

/// Most lags of a model that are summed: how long a sum over a slow drift may take.
inline constexpr int kLongestMemory = 5000;

/// Whether a series can have these autocovariances from lag 0 on: gamma[0] > 0 and all partial
/// autocorrelations within (-1, 1). Those of a series of zeros are none.
bool is_autocovariance(std::span<const double> gamma);

/// Autocovariances of the model itself for lags 0..lags.
std::vector<double> autocovariance(const Autoregression& model, int lags);

/// The model of order up to gamma.size() - 1 with the least Bayesian information criterion n
/// ln(variance) + order ln(n), by the recursion of Levinson and Durbin (Brockwell and Davis, Time
/// Series, 1991, 5.2 and 9.2). Partial autocorrelations are cut at 1 - 10 / n, so that no model has
/// a longer memory than the series can show. The first one of 1 or more after such a cut ends the
/// recursion.
///
/// @param gamma    autocovariances from lag 0, gamma[0] >= 0; white noise of variance 0 if it is 0
/// @param samples  n, length of the series, >= 1
Autoregression fit_autoregression(std::span<const double> gamma, double samples);

}  // namespace rigcal::metrics
