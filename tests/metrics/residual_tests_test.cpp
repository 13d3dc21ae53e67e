#include "metrics/residual_tests.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "metrics/distributions.hpp"

namespace {

using rigcal::metrics::residual_tests;
using rigcal::metrics::ResidualTests;

std::vector<double> white(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  for (double& value : values) value = normal(engine);
  return values;
}

std::vector<double> first_order(std::vector<double> values, double phi) {
  for (std::size_t i = 1; i < values.size(); ++i)
    values[i] = phi * values[i - 1] + std::sqrt(1.0 - phi * phi) * values[i];
  return values;
}

std::vector<double> sine(std::size_t n, double frequency_hz, double interval_s) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i)
    values[i] =
        std::sin(2.0 * std::numbers::pi * frequency_hz * interval_s * static_cast<double>(i));
  return values;
}

}  // namespace

TEST_CASE("residual_tests: each is passed by white noise about as often as its level says",
          "[metrics]") {
  const std::vector<double> input = sine(1000, 2.0, 0.01);
  int colour = 0, cross = 0, spectrum = 0, shape = 0, drift = 0;
  constexpr int kDraws = 200;
  for (unsigned seed = 0; seed < kDraws; ++seed) {
    const ResidualTests tests = residual_tests(white(1000, seed + 1), input, 0.01);
    colour += tests.autocorrelation.passed() ? 0 : 1;
    cross += tests.cross_correlation->passed() ? 0 : 1;
    spectrum += tests.periodogram.passed() ? 0 : 1;
    shape += tests.normality.passed() ? 0 : 1;
    drift += tests.drift.passed() ? 0 : 1;
  }
  // 5 % of 200 are 10, with a standard deviation of 3.1. The cross-correlation test rejects less
  // often because of Bonferroni's correction.
  CHECK(colour <= 22);
  CHECK(colour >= 2);
  CHECK(cross <= 22);
  CHECK(spectrum <= 22);
  CHECK(shape <= 22);
  CHECK(drift <= 22);
  CHECK(drift >= 1);
}

TEST_CASE("residual_tests: a first-order process has its known autocorrelation", "[metrics]") {
  const double phi = 0.95;
  const auto tests = residual_tests(first_order(white(20000, 7), phi), {}, 0.001);
  CHECK_FALSE(tests.autocorrelation.passed());
  CHECK_FALSE(tests.periodogram.passed());
  CHECK_FALSE(tests.cross_correlation.has_value());
  const auto& curve = tests.curves.autocorrelation;
  CHECK(curve.first_lag_s == 0.0);
  REQUIRE(curve.values.size() > 20);
  for (std::size_t i = 0; static_cast<double>(i) * curve.lag_step_s < 0.0205; ++i) {
    const double lag = std::round(static_cast<double>(i) * curve.lag_step_s / 0.001);
    CAPTURE(lag);
    // Bartlett's standard deviation at these lags is below 0.045.
    CHECK_THAT(curve.values[i], Catch::WithinAbs(std::pow(phi, lag), 0.12));
  }
  CHECK_THAT(tests.autocorrelation.durbin_watson, Catch::WithinAbs(2.0 * (1.0 - phi), 0.01));
  // n (1 - phi) / (1 + phi)
  CHECK_THAT(tests.effective_samples, Catch::WithinRel(20000.0 * 0.05 / 1.95, 0.35));
}

TEST_CASE("residual_tests: the correlation time is in seconds, and zero for white noise",
          "[metrics]") {
  const std::vector<double> coloured = first_order(white(5000, 7), 0.9);
  const auto time_s = [](const std::vector<double>& residual, double interval_s) {
    return residual_tests(residual, {}, interval_s).autocorrelation.correlation_time_s;
  };
  // 0.9^k falls below a quarter, far above the band for white noise, after 13 samples.
  CHECK(time_s(coloured, 0.001) > 0.013);
  CHECK_THAT(time_s(coloured, 0.01), Catch::WithinRel(10.0 * time_s(coloured, 0.001), 1e-12));
  CHECK(time_s(white(5000, 6), 0.001) == 0.0);
}

TEST_CASE("residual_tests: what follows the input late is found at its lag", "[metrics]") {
  const std::vector<double> input = first_order(white(4000, 3), 0.5);
  std::vector<double> residual = white(4000, 4);
  for (std::size_t i = 7; i < residual.size(); ++i) residual[i] += 0.5 * input[i - 7];
  const ResidualTests tests = residual_tests(residual, input, 0.01);
  REQUIRE(tests.cross_correlation.has_value());
  CHECK_FALSE(tests.cross_correlation->passed());
  CHECK_THAT(tests.cross_correlation->peak_lag_s, Catch::WithinAbs(0.07, 1e-12));
  CHECK_THAT(tests.cross_correlation->peak, Catch::WithinAbs(0.5 / std::sqrt(1.25), 0.05));
}

TEST_CASE("residual_tests: the curve of the cross-correlation lies about lag zero", "[metrics]") {
  const std::vector<double> input = white(1000, 14);
  std::vector<double> residual = white(1000, 15);
  for (std::size_t i = 3; i < residual.size(); ++i) residual[i] += 5.0 * input[i - 3];
  const auto curve = residual_tests(residual, input, 0.01).curves.cross_correlation.value();
  const auto peak = std::max_element(curve.values.begin(), curve.values.end());
  const auto place = static_cast<double>(peak - curve.values.begin());
  CHECK_THAT(curve.first_lag_s + place * curve.lag_step_s, Catch::WithinAbs(0.03, 1e-9));
}

TEST_CASE("residual_tests: a curve of many lags is thinned, and keeps lag zero", "[metrics]") {
  // The autocorrelation of a slow residual needs half of the record to fall: 1000 lags.
  const std::vector<double> residual = sine(2000, 0.05, 0.01);
  const auto curves = residual_tests(residual, residual, 0.01).curves;
  for (const auto& curve : {curves.autocorrelation, curves.cross_correlation.value()}) {
    CHECK(curve.values.size() > 150);
    CHECK(curve.values.size() <= 200);
    const auto at_zero =
        static_cast<std::size_t>(std::lround(-curve.first_lag_s / curve.lag_step_s));
    CHECK_THAT(curve.values.at(at_zero), Catch::WithinAbs(1.0, 1e-9));
  }
}

TEST_CASE("residual_tests: the periodogram finds a line and keeps the power", "[metrics]") {
  std::vector<double> residual = white(5000, 5);
  const std::vector<double> line = sine(5000, 10.0, 0.001);
  for (std::size_t i = 0; i < line.size(); ++i) residual[i] += 2.0 * line[i];
  const ResidualTests tests = residual_tests(residual, {}, 0.001);
  CHECK_FALSE(tests.periodogram.passed());
  CHECK_THAT(tests.periodogram.peak_frequency_hz, Catch::WithinAbs(10.0, 0.21));
  // The line has 2 of 3 units of variance.
  CHECK_THAT(tests.periodogram.peak_share, Catch::WithinAbs(2.0 / 3.0, 0.05));
  // White noise with variance 1 at 1 kHz has a one-sided density of 2 / 1000.
  const auto noise = residual_tests(white(5000, 6), {}, 0.001);
  CHECK_THAT(noise.curves.periodogram.density.back(), Catch::WithinRel(0.002, 0.2));
}

TEST_CASE("residual_tests: heavy tails and trends are named", "[metrics]") {
  std::vector<double> cubed = white(2000, 8);
  for (double& value : cubed) value = value * value * value;
  const auto heavy = residual_tests(cubed, {}, 0.01);
  CHECK_FALSE(heavy.normality.passed());
  CHECK(heavy.normality.excess_kurtosis > 5.0);
  CHECK(heavy.curves.normality.residual_quantile.back() >
        heavy.curves.normality.normal_quantile.back());

  std::vector<double> trend = white(2000, 9);
  for (std::size_t i = 0; i < trend.size(); ++i) trend[i] += 0.02 * 0.01 * static_cast<double>(i);
  const ResidualTests drift = residual_tests(trend, {}, 0.01);
  CHECK_FALSE(drift.drift.passed());
  // The standard error of the slope is 1 / (sqrt(2000) * 5.77 s) = 0.004 per s.
  CHECK_THAT(drift.drift.slope_per_s, Catch::WithinAbs(0.02, 0.016));
}

TEST_CASE("residual_tests: a normal sample lies on the line of the normal plot", "[metrics]") {
  constexpr int kSamples = 200;
  std::vector<double> sample(kSamples);
  std::vector<double> input(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const int shuffled = i * 77 % kSamples;
    sample[static_cast<std::size_t>(i)] =
        3.0 * rigcal::metrics::normal_quantile((shuffled + 0.5) / kSamples);
    input[static_cast<std::size_t>(i)] = i % 7;
  }
  const auto tests = residual_tests(sample, input, 0.01);
  const auto& plot = tests.curves.normality;
  REQUIRE(plot.normal_quantile.size() == plot.residual_quantile.size());
  for (std::size_t i = 0; i < plot.normal_quantile.size(); ++i) {
    CAPTURE(plot.normal_quantile[i]);
    // The value drawn is the nearest one in the sample, so it is at most half a rank away.
    const double drawn = rigcal::metrics::normal_cdf(plot.residual_quantile[i] * tests.std / 3.0);
    CHECK(std::abs(drawn - rigcal::metrics::normal_cdf(plot.normal_quantile[i])) <
          0.5001 / kSamples);
  }
}

TEST_CASE("residual_tests: offset and trend are tested at half the level each", "[metrics]") {
  // Mean and trend of the white noise are removed, and replaced by a mean and trend that give the
  // wanted p-value.
  constexpr std::size_t kCount = 400;
  std::vector<double> noise = white(kCount, 21);
  std::vector<double> time(kCount);
  double mean = 0.0, slope = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    time[i] = static_cast<double>(i) - 0.5 * (kCount - 1.0);
    mean += noise[i] / kCount;
  }
  for (std::size_t i = 0; i < kCount; ++i) slope += noise[i] * time[i];
  for (const double t : time) squares += t * t;
  for (std::size_t i = 0; i < kCount; ++i) noise[i] -= mean + slope / squares * time[i];
  const double sd = residual_tests(noise, {}, 0.01).std;
  const auto outcome_of = [&](double offset_z, double trend_z) {
    std::vector<double> residual = noise;
    for (std::size_t i = 0; i < kCount; ++i) {
      residual[i] += sd / std::sqrt(static_cast<double>(kCount)) *
                     (offset_z + trend_z * time[i] / std::sqrt(squares / kCount));
    }
    return residual_tests(residual, {}, 0.01).drift.outcome;
  };
  // The normal quantile for 1.25 % is 2.2414. A trend of this size increases the variance by 0.6 %.
  using rigcal::metrics::TestOutcome;
  CHECK(outcome_of(2.20, 0.0) == TestOutcome::passed);
  CHECK(outcome_of(-2.20, 0.0) == TestOutcome::passed);
  CHECK(outcome_of(2.28, 0.0) == TestOutcome::failed);
  CHECK(outcome_of(-2.28, 0.0) == TestOutcome::failed);
  CHECK(outcome_of(0.0, 2.20) == TestOutcome::passed);
  CHECK(outcome_of(0.0, 2.30) == TestOutcome::failed);
  CHECK(outcome_of(0.0, -2.30) == TestOutcome::failed);
}

TEST_CASE("residual_tests: a test without power is no pass", "[metrics]") {
  // Half a wave fills the record, which leaves hardly any independent samples.
  std::vector<double> slow = sine(2000, 0.25, 0.001);
  const std::vector<double> noise = white(2000, 11);
  for (std::size_t i = 0; i < slow.size(); ++i) slow[i] += 0.01 * noise[i];
  const ResidualTests tests = residual_tests(slow, noise, 0.001);
  CHECK(tests.effective_samples < 10.0);
  REQUIRE(tests.cross_correlation.has_value());
  using rigcal::metrics::TestOutcome;
  CHECK(tests.cross_correlation->outcome == TestOutcome::not_judged);
  CHECK(tests.normality.outcome == TestOutcome::not_judged);
  CHECK(tests.drift.outcome == TestOutcome::not_judged);
  CHECK(tests.drift.reason.has_value());
  // For the tests of whiteness, all 2000 samples count.
  CHECK(tests.autocorrelation.outcome == TestOutcome::failed);
  CHECK(tests.periodogram.outcome == TestOutcome::failed);

  // 50 white samples can show offsets, trends and correlations of half a standard deviation, but
  // not the tails of a distribution. 16 samples cannot show a spectrum either.
  const ResidualTests some = residual_tests(white(50, 12), white(50, 13), 0.001);
  CHECK(some.drift.outcome == TestOutcome::passed);
  CHECK(some.cross_correlation->outcome == TestOutcome::passed);
  CHECK(some.normality.outcome == TestOutcome::not_judged);
  const ResidualTests few = residual_tests(white(16, 14), white(16, 15), 0.001);
  CHECK(few.autocorrelation.outcome == TestOutcome::passed);
  CHECK(few.cross_correlation->outcome == TestOutcome::not_judged);
  CHECK(few.periodogram.outcome == TestOutcome::not_judged);
}

TEST_CASE("effective_sample_size: closed form of a geometric decay", "[metrics]") {
  using rigcal::metrics::effective_sample_size;
  std::vector<double> rho(1000, 0.0);
  for (std::size_t k = 0; k < rho.size(); ++k) rho[k] = std::pow(0.5, static_cast<double>(k));
  CHECK_THAT(effective_sample_size(rho), Catch::WithinRel(1000.0 / 3.0, 1e-12));
  // Only values before the first one that is not positive count.
  rho[2] = 0.0;
  CHECK_THAT(effective_sample_size(rho), Catch::WithinRel(500.0, 1e-12));
  // The first value is within 1.96 / sqrt(1000) = 0.06198, so the residual counts as white.
  rho[1] = 0.0619;
  CHECK(effective_sample_size(rho) == 1000.0);
  rho[1] = 0.0620;
  CHECK(effective_sample_size(rho) < 900.0);
  CHECK(effective_sample_size(std::vector<double>(1000, 1.0)) == 1.0);
}

TEST_CASE("residual_tests: does not depend on the unit", "[metrics]") {
  std::vector<double> residual = first_order(white(999, 10), 0.6);
  const std::vector<double> input = sine(999, 1.0, 0.01);
  const ResidualTests one = residual_tests(residual, input, 0.01);
  for (double& value : residual) value *= 1e-6;
  const ResidualTests other = residual_tests(residual, input, 0.01);
  CHECK_THAT(other.autocorrelation.ljung_box,
             Catch::WithinRel(one.autocorrelation.ljung_box, 1e-9));
  CHECK_THAT(other.cross_correlation->peak, Catch::WithinRel(one.cross_correlation->peak, 1e-9));
  CHECK_THAT(other.periodogram.distance, Catch::WithinRel(one.periodogram.distance, 1e-9));
  CHECK_THAT(other.normality.jarque_bera, Catch::WithinRel(one.normality.jarque_bera, 1e-9));
}

TEST_CASE("residual_tests: refuses what has no tests", "[metrics]") {
  const std::vector<double> few(15, 1.0);
  const std::vector<double> constant(100, 0.1);
  std::vector<double> broken = white(100, 1);
  CHECK_THROWS_AS(residual_tests(few, {}, 0.01), std::invalid_argument);
  CHECK_THROWS_AS(residual_tests(constant, {}, 0.01), std::domain_error);
  CHECK_THROWS_AS(residual_tests(broken, few, 0.01), std::invalid_argument);
  CHECK_THROWS_AS(residual_tests(broken, {}, 0.0), std::invalid_argument);
  broken[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(residual_tests(broken, {}, 0.01), std::invalid_argument);
}

TEST_CASE("residual tests: curves of partial autocorrelation and cumulative power", "[metrics]") {
  const auto power_of = [](const std::vector<double>& residual) {
    return residual_tests(residual, {}, 0.01).curves.cumulative_periodogram.value();
  };
  const auto partial_of = [](const std::vector<double>& residual) {
    return residual_tests(residual, {}, 0.01).curves.partial_autocorrelation.value().values;
  };
  const auto noise = power_of(white(2000, 31));
  REQUIRE(noise.fraction.size() == 51);
  CHECK(noise.fraction.front() == 0.0);
  CHECK_THAT(noise.fraction.back(), Catch::WithinAbs(1.0, 1e-9));
  CHECK_THAT(noise.last_frequency_hz, Catch::WithinRel(50.0, 1e-12));
  for (std::size_t i = 0; i < 51; ++i)
    CHECK(std::abs(noise.fraction[i] - static_cast<double>(i) / 50.0) < 0.08);
  REQUIRE(partial_of(white(2000, 31)).size() == 50);
  // A sine at 12.5 Hz, a quarter of the way to 50 Hz, has all its power in one line.
  const auto line = power_of(sine(2000, 12.5, 0.01)).fraction;
  CHECK(line[12] < 0.01);
  CHECK(line[13] > 0.99);
  const auto partial = partial_of(first_order(white(4000, 32), 0.8));
  CHECK_THAT(partial[0], Catch::WithinAbs(0.8, 0.05));
  CHECK(std::abs(partial[1]) < 0.08);
  // A short record has fewer lags, and lines between which the curve is interpolated.
  CHECK(partial_of(white(16, 33)).size() == 8);
  const auto few = power_of(white(16, 33)).fraction;
  CHECK(few.size() == 51);
  CHECK(std::is_sorted(few.begin(), few.end()));
}
