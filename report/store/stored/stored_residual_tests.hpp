#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "metrics/residual_tests.hpp"
#include "report/json/described.hpp"
#include "report/store/result.hpp"

// Results of the residual tests, in `residual_tests` of fit.json and in residual_tests.json.

namespace rigcal::report {

inline constexpr const char* kFitSchema = "rigcal.fit/2";
/// Earlier schema. Its `ci95` corresponds to the current `ci95_if_exact`.
inline constexpr const char* kEarlierFitSchema = "rigcal.fit/1";
/// Whether a schema belongs to a fit, written by this or an older version.
inline bool is_fit_schema(std::string_view schema) {
  return schema == kFitSchema || schema == kEarlierFitSchema;
}
inline constexpr const char* kValidationSchema = "rigcal.validation/1";

/// A residual test with its verdict in words. Verdict and outcome are the last keys in JSON.
template <typename Test>
struct Worded : Test {
  std::string verdict;
  std::optional<bool> has_passed;  ///< absent if not judged
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    Test::describe(self, visit);
    visit("verdict", self.verdict);
    visit("passed", self.has_passed);
    visit("outcome", self.outcome);
    visit("reason", self.reason);
  }
};

struct StoredResidualTests {
  long samples = 0;
  double sample_interval_s = 0.0, std = 0.0, effective_samples = 0.0;
  Worded<metrics::Autocorrelation> autocorrelation;
  std::optional<Worded<metrics::CrossCorrelation>> cross_correlation;
  Worded<metrics::Periodogram> periodogram;
  Worded<metrics::Normality> normality;
  Worded<metrics::Drift> drift;
  RIGCAL_DESCRIBE(samples, sample_interval_s, std, effective_samples, autocorrelation,
                  cross_correlation, periodogram, normality, drift)
};

/// An autocorrelation or cross-correlation at equally spaced lags, thinned.
struct StoredCorrelogram {
  double first_lag_s = 0.0, lag_step_s = 0.0;
  double band = 0.0;  ///< 95 % band for a single lag
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

/// Fraction of the power up to each frequency. The frequencies are equally spaced from zero.
struct StoredCumulative {
  double last_frequency_hz = 0.0;
  double limit = 0.0;  ///< 5 % critical distance from the straight line of white noise
  std::vector<double> fraction;
  RIGCAL_DESCRIBE(last_frequency_hz, limit, fraction)
};

/// The curves on which the tests of one channel are based.
struct StoredResidualCurves {
  StoredCorrelogram autocorrelation;
  std::optional<StoredCorrelogram> cross_correlation;
  StoredSpectrum periodogram;
  StoredQuantiles normality;
  Later<std::optional<StoredCorrelogram>> partial_autocorrelation;
  Later<std::optional<StoredCumulative>> cumulative_periodogram;
  RIGCAL_DESCRIBE(autocorrelation, cross_correlation, periodogram, normality,
                  partial_autocorrelation, cumulative_periodogram)
};

/// Curves by channel; null if the residual was not tested.
using StoredChannelCurves = Keyed<std::optional<StoredResidualCurves>>;

/// Content of residual_tests.json.
struct StoredCurves {
  calib::FitStatus status = calib::FitStatus::failed;
  std::string schema = "rigcal.residual_tests/1";
  std::string of;  ///< schema of the result
  Keyed<StoredChannelCurves> conditions;
  RIGCAL_DESCRIBE(status, schema, of, conditions)
};

/// Converts residual tests to their stored form.
///
/// @param unit  SI unit of the residual
StoredResidualTests stored(const metrics::ResidualTests& tests, std::string_view unit);

StoredCurves stored_curves(const Result& result);

}  // namespace rigcal::report
