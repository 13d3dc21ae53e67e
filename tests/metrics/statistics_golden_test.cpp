// Compares the statistics in this folder with SciPy and statsmodels
// (tests/golden/make_statistics_golden.py).

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "metrics/autoregression.hpp"
#include "metrics/distributions.hpp"
#include "metrics/fundamental.hpp"
#include "metrics/mean_absolute.hpp"
#include "metrics/residual_features.hpp"
#include "metrics/residual_tests.hpp"
#include "metrics/significance.hpp"
#include "metrics/trend.hpp"
#include "tests/support/golden.hpp"

using namespace rigcal::metrics;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::golden;
using rigcal::test::golden_lines;

namespace {

// Both sides round, in sums of hundreds of terms and in series for special functions.
constexpr double kGoldenRounding = 1e-10;

void check_value(double found, double expected) {
  CHECK_THAT(found, WithinRel(expected, kGoldenRounding) || WithinAbs(expected, 1e-14));
}

void check_values(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i);
    CHECK_THAT(found[i], WithinRel(expected[i], kGoldenRounding) || WithinAbs(expected[i], 1e-12));
  }
}

using Function = std::function<double(const std::vector<double>&)>;

// The tolerance is 1e-8 because SciPy's quantile of t has nine digits.
void check_function(const std::string& name, const Function& function) {
  for (const std::vector<double>& line : golden_lines(name)) {
    CAPTURE(name, line);
    CHECK_THAT(function(line), WithinRel(line.back(), 1e-8));
  }
}

}  // namespace

TEST_CASE("golden: distributions", "[metrics]") {
  check_function("normal_quantile", [](const auto& x) { return normal_quantile(x[0]); });
  check_function("normal_cdf", [](const auto& x) { return normal_cdf(x[0]); });
  check_function("student_t_quantile",
                 [](const auto& x) { return student_t_quantile(x[0], x[1]); });
  check_function("student_t_cdf", [](const auto& x) { return student_t_cdf(x[0], x[1]); });
  check_function("chi_squared_exceedance",
                 [](const auto& x) { return chi_squared_exceedance(x[0], x[1]); });
  check_function("fisher_f_exceedance",
                 [](const auto& x) { return fisher_f_exceedance(x[0], x[1], x[2]); });
  check_function("binomial_cdf", [](const auto& x) {
    return binomial_cdf(static_cast<int>(x[0]), static_cast<int>(x[1]), x[2]);
  });
}

TEST_CASE("golden: residual tests", "[metrics]") {
  const std::string name = GENERATE("white", "coloured", "skewed");
  CAPTURE(name);
  const auto value = [&](const char* key) { return golden(name + "." + key).front(); };
  const TestedResidual tests =
      residual_tests(golden(name + ".residual"), golden(name + ".input"), 0.01);

  const Autocorrelation& own = tests.autocorrelation;
  const std::vector<double> rho = golden(name + ".autocorrelation");
  CHECK(own.tested_lags == static_cast<int>(rho.size()) - 1);
  const std::vector<double>& curve = tests.curves.autocorrelation.values;
  check_values({curve.begin(), curve.begin() + own.tested_lags + 1}, rho);
  check_value(own.ljung_box, value("ljung_box"));
  check_value(own.p_value, value("ljung_box_p"));
  check_value(own.durbin_watson, value("durbin_watson"));
  check_value(tests.effective_samples, value("effective_samples"));

  REQUIRE(tests.cross_correlation.has_value());
  check_value(tests.cross_correlation->peak, value("cross_correlation"));
  CHECK_THAT(tests.cross_correlation->peak_lag_s, WithinAbs(value("cross_lag_s"), 1e-12));
  check_value(tests.cross_correlation->limit, value("cross_band"));
  CHECK_THAT(tests.curves.cross_correlation->band,
             WithinRel(1.96 / std::sqrt(value("effective_samples")), 1e-12));

  const Periodogram& spectrum = tests.periodogram;
  check_value(spectrum.distance, value("periodogram_distance"));
  // The constant 1.3581 is printed with four digits.
  CHECK_THAT(spectrum.limit, WithinRel(value("periodogram_limit"), 1e-4));
  check_value(tests.curves.periodogram.frequency_hz.front(),
              golden(name + ".periodogram_lowest")[0]);
  // If the number of samples is even, the last line represents one frequency rather than two. This
  // changes the other lines by half of its fraction of the power, here at most 3 %.
  CHECK_THAT(tests.curves.periodogram.density.front(),
             WithinRel(golden(name + ".periodogram_lowest")[1], 0.04));
  check_value(spectrum.median_frequency_hz, value("periodogram_median_hz"));
  check_value(spectrum.peak_frequency_hz, golden(name + ".periodogram_peak")[0]);
  check_value(spectrum.peak_share, golden(name + ".periodogram_peak")[1]);

  check_value(tests.normality.skewness, value("skewness"));
  check_value(tests.normality.excess_kurtosis, value("excess_kurtosis"));
  check_value(tests.normality.jarque_bera, value("jarque_bera"));
  check_value(tests.normality.p_value, value("jarque_bera_p"));

  check_value(tests.drift.mean, value("mean"));
  check_value(tests.drift.mean_p_value, value("mean_p"));
  check_value(tests.drift.slope_per_s, value("slope_per_s"));
  check_value(tests.drift.slope_p_value, value("slope_p"));
}

TEST_CASE("golden: autoregression of an order by BIC", "[metrics]") {
  const std::string name = GENERATE("first_order", "ringing");
  CAPTURE(name);
  const std::vector<double> series = golden(name + ".series");
  const auto samples = static_cast<double>(series.size());
  const std::vector<double> gamma = autocovariance(series, 12);
  check_values(gamma, golden(name + ".autocovariance"));
  const Autoregression model = fit_autoregression(gamma, samples);
  check_values(model.phi, golden(name + ".phi"));
  check_value(model.variance, golden(name + ".variance").front());
  check_values(autocovariance(model, 12), golden(name + ".model_autocovariance"));
  check_value(model.effective_samples(samples), golden(name + ".effective_samples").front());
}

TEST_CASE("golden: significance", "[metrics]") {
  check_values(holm(golden("holm.p")), golden("holm.adjusted"));
  check_function("sign_test", [](const auto& x) {
    return sign_test_p_value(static_cast<int>(x[0]), static_cast<int>(x[1]));
  });
  for (const std::string name : {"trend_wide", "trend_narrow"}) {
    CAPTURE(name);
    std::vector<EstimateError> errors;
    for (const double error : golden(name + ".error")) errors.push_back({error});
    const Trend trend = weighted_trend(golden(name + ".x"), golden(name + ".y"), errors);
    check_values(
        {trend.slope, trend.intercept, trend.slope_standard_error, trend.reduced_chi_square},
        golden(name + ".line"));
    // SciPy's quantile of t has nine digits.
    CHECK_THAT(trend.ci95_low, WithinRel(golden(name + ".ci95")[0], 1e-8));
    CHECK_THAT(trend.ci95_high, WithinRel(golden(name + ".ci95")[1], 1e-8));
    check_value(trend.p_value, golden(name + ".p_value").front());
  }
}

TEST_CASE("golden: fundamental of noisy, uneven samples", "[metrics]") {
  const std::vector<double> time_s = golden("fundamental.time_s");
  const Fundamental line = fundamental(time_s, golden("fundamental.measured"), 1.7);
  check_values({line.amplitude, line.phase_rad}, golden("fundamental.measured_line"));
  const FundamentalComparison both = compare_fundamentals(time_s, golden("fundamental.measured"),
                                                          golden("fundamental.simulated"), 1.7);
  check_values({both.gain_ratio, both.phase_deg, both.delay_s}, golden("fundamental.comparison"));
}

TEST_CASE("golden: mean absolute value and residual features", "[metrics]") {
  const std::vector<double> time_s = golden("leak.time_s");
  check_value(mean_absolute(time_s, golden("leak.servo")), golden("leak.mean_absolute").front());
  const ResidualFeatures features = residual_features(golden("features.residual"));
  check_values({features.mean, features.rms, features.std}, golden("features.values"));
}
