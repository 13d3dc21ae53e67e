#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/describe.hpp"
#include "metrics/test_outcome.hpp"

namespace rigcal::metrics {

// Tests of the residual e of one record: what a model that explains everything leaves is white,
// normal, without drift, and uncorrelated with the input. Equidistant samples. Each test is at the
// 5 % level and passed, failed, or not judged where it has no power (test_outcome.hpp). Tests of
// whiteness count every sample, as white noise does; the others use the effective sample size where
// the samples are correlated, and are approximate there.

/// Correlation of the residual with itself: white noise has none.
struct Autocorrelation : Judged {
  std::vector<double> values;  ///< shape (lags + 1), from lag 0; biased estimate, values[0] = 1
  double band = 0.0;           ///< 95 % of the values of white noise are within +-band
  double ljung_box = 0.0;      ///< Ljung and Box, Biometrika 65, 1978, over `tested_lags`
  int tested_lags = 0;
  double p_value = 0.0;
  double durbin_watson = 0.0;       ///< 2 for white noise, 0 for a residual that only creeps
  double correlation_time_s = 0.0;  ///< until the autocorrelation first falls within the band
  RIGCAL_DESCRIBE(ljung_box, tested_lags, p_value, durbin_watson, correlation_time_s)
};

/// Correlation of the residual with the input of the rig.
struct CrossCorrelation : Judged {
  std::vector<double> values;  ///< shape (2 lags + 1), from -lags: corr(e(t), u(t - lag))
  double band = 0.0;           ///< 95 % for one lag, by the effective sample size
  double limit = 0.0;          ///< 95 % for the largest of all lags (Bonferroni)
  double peak = 0.0;           ///< value of largest size
  double peak_lag_s = 0.0;     ///< > 0: the residual follows the input
  RIGCAL_DESCRIBE(peak, peak_lag_s, limit)
};

/// Distribution of the residual's power over frequency.
struct Periodogram : Judged {
  std::vector<double> frequency_hz;  ///< shape (bins), logarithmic bins of the periodogram
  std::vector<double> density;       ///< mean one-sided power density, [unit^2/Hz]
  double median_frequency_hz = 0.0;  ///< half of the power is below it
  double peak_frequency_hz = 0.0;    ///< frequency of the largest single line
  double peak_share = 0.0;           ///< fraction of the power in that line and its two neighbours
  double distance = 0.0;             ///< cumulative periodogram to a straight line (Bartlett)
  double limit = 0.0;                ///< 5 % critical distance of white noise
  RIGCAL_DESCRIBE(distance, limit, median_frequency_hz, peak_frequency_hz, peak_share)
};

/// Distribution of the residual.
struct Normality : Judged {
  std::vector<double> normal_quantile;    ///< shape (points), of the standard normal
  std::vector<double> residual_quantile;  ///< quantiles of (e - mean) / std
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  double jarque_bera = 0.0;  ///< Jarque and Bera, Economics Letters 6, 1980
  double p_value = 0.0;
  RIGCAL_DESCRIBE(skewness, excess_kurtosis, jarque_bera, p_value)
};

/// Whether the residual has a mean or a trend that differs from zero.
struct Drift : Judged {
  double mean = 0.0;  ///< in the unit of e
  double mean_p_value = 0.0;
  double slope_per_s = 0.0;  ///< least squares, unit of e per second
  double slope_p_value = 0.0;
  RIGCAL_DESCRIBE(mean, mean_p_value, slope_per_s, slope_p_value)
};

struct ResidualTests {
  long samples = 0;
  double std = 0.0;                ///< standard deviation of the residual
  double effective_samples = 0.0;  ///< effective_sample_size()
  double sample_interval_s = 0.0;
  Autocorrelation autocorrelation;
  std::optional<CrossCorrelation> cross_correlation;  ///< absent where the input is constant
  Periodogram periodogram;
  Normality normality;
  Drift drift;
};

/// Effective sample size: the number of independent samples that determine the mean as well as n
/// correlated ones, n / (1 + 2 sum of rho) with the autocorrelations up to the first that is not
/// positive (Geyer, Statistical Science 7, 1992, without his pairs). It is n if the first is within
/// the 95 % band of white noise. Later negative autocorrelations do not raise it, which is on the
/// safe side.
///
/// @param rho  shape (n), n >= 1, from lag 0: rho[0] = 1
/// @return     in [1, n]
double effective_sample_size(std::span<const double> rho);

/// @param residual           shape (n), n >= 16, any unit
/// @param input              shape (n), or empty: reference or command
/// @param sample_interval_s  > 0
/// @throws std::invalid_argument  sizes differ, n < 16, a value or interval is not finite
/// @throws std::domain_error      the residual is constant
ResidualTests residual_tests(std::span<const double> residual, std::span<const double> input,
                             double sample_interval_s);

}  // namespace rigcal::metrics
