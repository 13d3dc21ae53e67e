#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rigcal::metrics {

// Tests of the residual e of one record: what a model that explains everything leaves is white,
// normal, without drift, and tells nothing of the input. Equidistant samples. Each test is at the
// 5 % level; p values and bands use the effective number of samples where the samples are
// correlated, and are approximate there.

/// Correlation of the residual with itself.
struct Autocorrelation {
  std::vector<double> values;  ///< shape (lags + 1), from lag 0; biased estimate, values[0] = 1
  double band = 0.0;           ///< 95 % of the values of white noise lie within +-band
  double ljung_box = 0.0;      ///< Ljung and Box, Biometrika 65, 1978, over `tested_lags`
  int tested_lags = 0;
  double p_value = 0.0;
  double durbin_watson = 0.0;       ///< 2 for white noise, 0 for a residual that only creeps
  double correlation_time_s = 0.0;  ///< until the autocorrelation first falls within the band
  bool passed = false;
};

/// Correlation of the residual with the input of the rig.
struct CrossCorrelation {
  std::vector<double> values;  ///< shape (2 lags + 1), from -lags: corr(e(t), u(t - lag))
  double band = 0.0;           ///< 95 % for one lag, by the effective number of samples
  double band_of_peak = 0.0;   ///< 95 % for the largest of all lags (Bonferroni)
  double peak = 0.0;           ///< of largest absolute value
  double peak_lag_s = 0.0;     ///< > 0: the residual follows the input
  bool passed = false;
};

/// Where in frequency the residual has its power.
struct Periodogram {
  std::vector<double> frequency_hz;  ///< shape (bins), logarithmic bins of the periodogram
  std::vector<double> density;       ///< mean one-sided power density, [unit^2/Hz]
  double median_frequency_hz = 0.0;  ///< half of the power lies below
  double peak_frequency_hz = 0.0;    ///< of the largest single line
  double peak_share = 0.0;           ///< of the power in that line and its two neighbours
  double distance = 0.0;  ///< of the cumulative periodogram from a straight line (Bartlett)
  double limit = 0.0;     ///< 5 % critical distance of white noise
  bool passed = false;
};

/// Distribution of the residual.
struct Normality {
  std::vector<double> normal_quantile;    ///< shape (points), of the standard normal
  std::vector<double> residual_quantile;  ///< of (e - mean) / std
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  double jarque_bera = 0.0;  ///< Jarque and Bera, Economics Letters 6, 1980
  double p_value = 0.0;
  bool passed = false;
};

/// Whether the residual has a mean or a trend.
struct Drift {
  double mean = 0.0;  ///< in the unit of e
  double mean_p_value = 0.0;
  double slope_per_s = 0.0;  ///< least squares, unit of e per second
  double slope_p_value = 0.0;
  bool passed = false;  ///< neither differs from zero
};

struct ResidualTests {
  long samples = 0;
  double std = 0.0;                ///< of the residual
  double effective_samples = 0.0;  ///< n / (1 + 2 sum of the first positive autocorrelations)
  double sample_interval_s = 0.0;
  Autocorrelation autocorrelation;
  std::optional<CrossCorrelation> cross_correlation;  ///< absent where the input is constant
  Periodogram periodogram;
  Normality normality;
  Drift drift;
};

/// @param residual           shape (n), n >= 16, any unit
/// @param input              shape (n), or empty: reference or command
/// @param sample_interval_s  > 0
/// @throws std::invalid_argument  sizes differ, n < 16, a value or interval is not finite
/// @throws std::domain_error      the residual is constant
ResidualTests residual_tests(std::span<const double> residual, std::span<const double> input,
                             double sample_interval_s);

}  // namespace rigcal::metrics
