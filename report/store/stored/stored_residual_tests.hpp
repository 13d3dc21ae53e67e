#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "metrics/residual_tests.hpp"
#include "report/json/described.hpp"
#include "report/store/result.hpp"

// Results of the residual tests, as in `residual_tests` of fit.json and in residual_tests.json.

namespace rigcal::report {

inline constexpr const char* kFitSchema = "rigcal.fit/2";
/// Whose `ci95` is what is `ci95_if_exact` today.
inline constexpr const char* kEarlierFitSchema = "rigcal.fit/1";
/// Whether a result is a fit, of this or of an earlier version.
inline bool is_fit_schema(std::string_view schema) {
  return schema == kFitSchema || schema == kEarlierFitSchema;
}
inline constexpr const char* kValidationSchema = "rigcal.validation/1";

template <>
inline std::vector<calib::FitStatus> every() {
  using calib::FitStatus;
  return {FitStatus::converged, FitStatus::stopped, FitStatus::failed};
}
template <>
inline std::vector<metrics::TestOutcome> every() {
  using metrics::TestOutcome;
  return {TestOutcome::passed, TestOutcome::failed, TestOutcome::not_judged};
}

/// Outcome of a test of residuals, in words too; the last keys of each.
struct StoredTest {
  std::string verdict;
  std::optional<bool> passed;  ///< null: not judged
  metrics::TestOutcome outcome = metrics::TestOutcome::not_judged;
  std::optional<std::string> reason;  ///< why it is not judged
  RIGCAL_DESCRIBE(verdict, passed, outcome, reason)
};
/// A test with numbers of its own, which come first.
#define RIGCAL_DESCRIBE_TEST(...)                        \
  template <typename Self, typename Visit>               \
  static void describe(Self& self, const Visit& visit) { \
    RIGCAL_AGAIN(RIGCAL_VISIT_MEMBERS(__VA_ARGS__))      \
    StoredTest::describe(self, visit);                   \
  }

struct StoredAutocorrelation : StoredTest {
  double ljung_box = 0.0;
  int tested_lags = 0;
  double p_value = 0.0, durbin_watson = 0.0, correlation_time_s = 0.0;
  RIGCAL_DESCRIBE_TEST(ljung_box, tested_lags, p_value, durbin_watson, correlation_time_s)
};

struct StoredCrossCorrelation : StoredTest {
  double peak = 0.0, peak_lag_s = 0.0, limit = 0.0;
  RIGCAL_DESCRIBE_TEST(peak, peak_lag_s, limit)
};

struct StoredPeriodogram : StoredTest {
  double distance = 0.0, limit = 0.0, median_frequency_hz = 0.0, peak_frequency_hz = 0.0,
         peak_share = 0.0;
  RIGCAL_DESCRIBE_TEST(distance, limit, median_frequency_hz, peak_frequency_hz, peak_share)
};

struct StoredNormality : StoredTest {
  double skewness = 0.0, excess_kurtosis = 0.0, jarque_bera = 0.0, p_value = 0.0;
  RIGCAL_DESCRIBE_TEST(skewness, excess_kurtosis, jarque_bera, p_value)
};

struct StoredDrift : StoredTest {
  double mean = 0.0, mean_p_value = 0.0, slope_per_s = 0.0, slope_p_value = 0.0;
  RIGCAL_DESCRIBE_TEST(mean, mean_p_value, slope_per_s, slope_p_value)
};

#undef RIGCAL_DESCRIBE_TEST

struct StoredResidualTests {
  long samples = 0;
  double sample_interval_s = 0.0, std = 0.0, effective_samples = 0.0;
  StoredAutocorrelation autocorrelation;
  std::optional<StoredCrossCorrelation> cross_correlation;
  StoredPeriodogram periodogram;
  StoredNormality normality;
  StoredDrift drift;
  RIGCAL_DESCRIBE(samples, sample_interval_s, std, effective_samples, autocorrelation,
                  cross_correlation, periodogram, normality, drift)
};

/// An autocorrelation or cross-correlation over equally spaced lags, thinned.
struct StoredCorrelogram {
  double first_lag_s = 0.0, lag_step_s = 0.0;
  double band = 0.0;  ///< 95 % for one lag
  Omittable<double> band_of_peak;
  std::vector<double> values;
  RIGCAL_DESCRIBE(first_lag_s, lag_step_s, band, band_of_peak, values)
};

struct StoredSpectrum {
  std::vector<double> frequency_hz, density;
  RIGCAL_DESCRIBE(frequency_hz, density)
};

struct StoredQuantiles {
  std::vector<double> normal_quantile, residual_quantile;
  RIGCAL_DESCRIBE(normal_quantile, residual_quantile)
};

/// The curves behind the tests of one channel.
struct StoredResidualCurves {
  StoredCorrelogram autocorrelation;
  std::optional<StoredCorrelogram> cross_correlation;
  StoredSpectrum periodogram;
  StoredQuantiles normality;
  RIGCAL_DESCRIBE(autocorrelation, cross_correlation, periodogram, normality)
};

/// By channel; null if the residual was not tested.
using StoredChannelCurves = Keyed<std::optional<StoredResidualCurves>>;

/// residual_tests.json
struct StoredCurves {
  calib::FitStatus status = calib::FitStatus::failed;
  std::string schema = "rigcal.residual_tests/1";
  std::string of;  ///< schema of the result
  Keyed<StoredChannelCurves> conditions;
  RIGCAL_DESCRIBE(status, schema, of, conditions)
};

/// @param unit  of the residual, SI
StoredResidualTests stored(const metrics::ResidualTests& tests, std::string_view unit);

StoredCurves stored_curves(const Result& result);

}  // namespace rigcal::report
