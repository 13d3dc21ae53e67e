#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/describe.hpp"
#include "metrics/test_outcome.hpp"

namespace rigcal::metrics {

// Tests of the residual e of one record. A model that explains everything leaves a residual that is
// white, normal, without drift, and uncorrelated with the input. Samples are equidistant. Each test
// is at the 5 % level and is passed, failed, or not judged if it has no power (test_outcome.hpp).
// Tests for whiteness count every sample, as is correct for white noise. The others use the
// effective sample size if samples are correlated, and are then approximate.

/// Correlation of the residual with itself. White noise has none.
struct Autocorrelation : Judged {
  double ljung_box = 0.0;  ///< Ljung and Box, Biometrika 65, 1978, over `tested_lags`
  int tested_lags = 0;
  double p_value = 0.0;
  double durbin_watson = 0.0;       ///< 2 for white noise, 0 for a residual that varies only slowly
  double correlation_time_s = 0.0;  ///< time until the autocorrelation first falls within the band
  RIGCAL_DESCRIBE(ljung_box, tested_lags, p_value, durbin_watson, correlation_time_s)
};

/// Correlation of the residual with the input of the rig.
struct CrossCorrelation : Judged {
  double limit = 0.0;       ///< 95 % bound for the largest of all lags (Bonferroni)
  double peak = 0.0;        ///< value with the largest magnitude
  double peak_lag_s = 0.0;  ///< > 0 if the residual lags behind the input
  RIGCAL_DESCRIBE(peak, peak_lag_s, limit)
};

/// Distribution of the residual's power over frequency.
struct Periodogram : Judged {
  double median_frequency_hz = 0.0;  ///< half of the power is below it
  double peak_frequency_hz = 0.0;    ///< frequency of the largest single line
  double peak_share = 0.0;           ///< fraction of the power in that line and its two neighbours
  double distance = 0.0;  ///< from the cumulative periodogram to a straight line (Bartlett)
  double limit = 0.0;     ///< 5 % critical distance for white noise
  RIGCAL_DESCRIBE(distance, limit, median_frequency_hz, peak_frequency_hz, peak_share)
};

/// Distribution of the residual.
struct Normality : Judged {
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  double jarque_bera = 0.0;  ///< Jarque and Bera, Economics Letters 6, 1980
  double p_value = 0.0;
  RIGCAL_DESCRIBE(skewness, excess_kurtosis, jarque_bera, p_value)
};

/// Tests whether the residual has a mean or a trend that differs from zero.
struct Drift : Judged {
  double mean = 0.0;  ///< in the unit of e
  double mean_p_value = 0.0;
  double slope_per_s = 0.0;  ///< least squares, unit of e per second
  double slope_p_value = 0.0;
  RIGCAL_DESCRIBE(mean, mean_p_value, slope_per_s, slope_p_value)
};

/// A test with its verdict in words, which its user adds. Verdict and outcome are the last keys in
/// files.
template <typename Test>
struct Worded : Test {
  std::string verdict;

  Worded() = default;
  Worded(Test test)
      : Test(std::move(test)) {}  // NOLINT(google-explicit-constructor): a Test itself

  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    Test::describe(self, visit);
    visit("verdict", self.verdict);
    std::optional<bool> passed;  // follows from the outcome; null if not judged
    if (self.passed() || self.failed()) passed = self.passed();
    visit("passed", passed);
    visit("outcome", self.outcome);
    visit("reason", self.reason);
  }
};

struct ResidualTests {
  long samples = 0;
  double sample_interval_s = 0.0;
  double std = 0.0;                ///< standard deviation of the residual
  double effective_samples = 0.0;  ///< see effective_sample_size()
  Worded<Autocorrelation> autocorrelation;
  std::optional<Worded<CrossCorrelation>> cross_correlation;  ///< absent if the input is constant
  Worded<Periodogram> periodogram;
  Worded<Normality> normality;
  Worded<Drift> drift;
  RIGCAL_DESCRIBE(samples, sample_interval_s, std, effective_samples, autocorrelation,
                  cross_correlation, periodogram, normality, drift)
};

/// An autocorrelation or cross-correlation at equally spaced lags.
struct Correlogram {
  double first_lag_s = 0.0, lag_step_s = 0.0;
  double band = 0.0;               ///< 95 % band for a single lag
  Omittable<double> band_of_peak;  ///< 95 % bound for the largest of all lags
  std::vector<double> values;
  RIGCAL_DESCRIBE(first_lag_s, lag_step_s, band, band_of_peak, values)
};

/// Mean one-sided power density [unit^2/Hz] in logarithmic bins, shape (bins).
struct Spectrum {
  std::vector<double> frequency_hz, density;
  RIGCAL_DESCRIBE(frequency_hz, density)
};

/// Quantiles of (e - mean) / std and those of the standard normal distribution, shape (points).
struct Quantiles {
  std::vector<double> normal_quantile, residual_quantile;
  RIGCAL_DESCRIBE(normal_quantile, residual_quantile)
};

/// Fraction of the power up to each frequency, shape (51). The frequencies are equally spaced from
/// zero. For white noise it is a straight line from 0 to 1.
struct CumulativePower {
  double last_frequency_hz = 0.0;  ///< half the sampling rate
  double limit = 0.0;              ///< 5 % critical distance from the line of white noise
  std::vector<double> fraction;
  RIGCAL_DESCRIBE(last_frequency_hz, limit, fraction)
};

/// The curves behind the tests, thinned for drawing.
struct ResidualCurves {
  Correlogram autocorrelation;  ///< from lag 0; biased estimate
  /// corr(e(t), u(t - lag)) on both sides of lag 0; absent if the input is constant.
  std::optional<Correlogram> cross_correlation;
  Spectrum periodogram;
  Quantiles normality;
  /// From lag 1, at most 50 lags, not thinned: the order of a model is the number of the last lag
  /// beyond the band.
  Later<std::optional<Correlogram>> partial_autocorrelation;
  Later<std::optional<CumulativePower>> cumulative_periodogram;
  RIGCAL_DESCRIBE(autocorrelation, cross_correlation, periodogram, normality,
                  partial_autocorrelation, cumulative_periodogram)
};

struct TestedResidual : ResidualTests {
  ResidualCurves curves;
};

/// Effective sample size: the number of independent samples that would determine the mean as
/// precisely as n correlated ones, n / (1 + 2 sum of rho). Autocorrelations are summed up to the
/// first that is not positive (Geyer, Statistical Science 7, 1992, without his pairs). The size is
/// n if the first one is within the 95 % band for white noise. Later negative autocorrelations do
/// not increase it, which is on the safe side.
///
/// @param rho  shape (n), n >= 1, from lag 0: rho[0] = 1
/// @return     in [1, n]
double effective_sample_size(std::span<const double> rho);

/// Runs all tests on the residual of one record.
///
/// @param residual           shape (n), n >= 16, any unit
/// @param input              shape (n), or empty: reference or command
/// @param sample_interval_s  > 0
/// @throws std::invalid_argument  if sizes differ, n < 16, or a value or the interval is not finite
/// @throws std::domain_error      if the residual is constant
TestedResidual residual_tests(std::span<const double> residual, std::span<const double> input,
                              double sample_interval_s);

}  // namespace rigcal::metrics
