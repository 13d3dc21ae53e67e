#include "datasets/prepare/lag.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/support/sanitized.hpp"

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

using Shape = std::function<double(double)>;

/// Delay of b relative to a, in samples.
std::optional<double> lag_in_samples(const std::vector<double>& a, const std::vector<double>& b,
                                     int max_lag) {
  const auto lag = find_lag(a, b, max_lag);
  return lag ? std::optional(lag->samples) : std::nullopt;
}

std::vector<double> sampled(const Shape& shape, int samples, double delay, double noise_sd,
                            unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x;
  for (int i = 0; i < samples; ++i) x.push_back(shape(i - delay) + noise_sd * normal(engine));
  return x;
}

Shape sine(double frequency) {
  return [=](double t) { return std::sin(2.0 * std::numbers::pi * frequency * t); };
}

/// A square wave with unit amplitude after two equal lags of `rise` samples, settled in each half
/// period.
Shape soft_square(double period, double rise) {
  return [=](double t) {
    const double phase = t - period * std::floor(t / period);
    const double half = 0.5 * period;
    const double x = std::fmod(phase, half) / rise;
    return (phase < half ? 1.0 : -1.0) * (1.0 - 2.0 * std::exp(-x) * (1.0 + x));
  };
}

struct Errors {
  double rms = 0.0;
  double predicted = 0.0;
};

Errors errors_of(const Shape& shape, int samples, double noise_sd, double largest_delay) {
  constexpr int kDraws = rigcal::test::kSanitized ? 15 : 30;
  double squares = 0.0;
  double variances = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double delay = largest_delay * (2.0 * draw / (kDraws - 1) - 1.0);
    const auto lag = find_lag(sampled(shape, samples, 0.0, noise_sd, 2 * draw + 1),
                              sampled(shape, samples, delay, noise_sd, 2 * draw + 2), 200);
    REQUIRE(lag.has_value());
    squares += (lag->samples - delay) * (lag->samples - delay);
    variances += lag->sd_samples * lag->sd_samples;
  }
  return {std::sqrt(squares / kDraws), std::sqrt(variances / kDraws)};
}

}  // namespace

TEST_CASE("lag: band-limited records are timed to 0.02 samples", "[datasets]") {
  CHECK(errors_of(sine(0.01), 10000, 0.01, 20.3).rms < 0.01);
  CHECK(errors_of(sine(0.1), 1000, 0.05, 4.1).rms < 0.02);
}

TEST_CASE("lag: square-like records with noise are timed to 0.02 samples", "[datasets]") {
  CHECK(errors_of(soft_square(100, 3), 10000, 0.01, 20.3).rms < 0.005);
  // With noise of a tenth of the amplitude, no estimator does better than 0.016.
  CHECK(errors_of(soft_square(100, 3), 10000, 0.1, 20.3).rms < 0.025);
}

TEST_CASE("lag: its standard deviation is that of its errors", "[datasets]") {
  // The rms of 30 draws has a standard deviation of 13 %, that of 15 draws 18 %.
  const auto slow = errors_of(sine(1e-4), 20000, 0.01, 5.3);
  CHECK_THAT(slow.predicted / slow.rms, WithinAbs(1.0, 0.4));
  const auto noisy = errors_of(soft_square(100, 3), 10000, 0.1, 5.3);
  CHECK_THAT(noisy.predicted / noisy.rms, WithinAbs(1.0, 0.4));
}

TEST_CASE("lag: positive if the second record is late", "[datasets]") {
  const auto early = sampled(soft_square(100, 3), 1000, 0.0, 0.0, 1);
  const auto late = sampled(soft_square(100, 3), 1000, 7.0, 0.0, 1);
  CHECK_THAT(lag_in_samples(early, late, 20).value(), WithinAbs(7.0, 0.02));
  CHECK_THAT(lag_in_samples(late, early, 20).value(), WithinAbs(-7.0, 0.02));
}

TEST_CASE("lag: gain and offset of a record do not matter", "[datasets]") {
  auto b = sampled(sine(0.013), 3000, 3.3, 0.0, 1);
  for (double& value : b) value = 40.0 + 0.25 * value;
  CHECK_THAT(lag_in_samples(sampled(sine(0.013), 3000, 0.0, 0.0, 1), b, 30).value(),
             WithinAbs(3.3, 0.005));
}

TEST_CASE("lag: a period is never jumped", "[datasets]") {
  // With 33.33 samples per period, the peak one period away is closer to a whole sample than the
  // true one, and ten periods are within the search range.
  for (const double delay : {0.5, -0.5, 12.4, -15.5}) {
    CAPTURE(delay);
    const auto a = sampled(sine(0.03), 2000, 0.0, 0.02, 3);
    const auto b = sampled(sine(0.03), 2000, delay, 0.02, 4);
    CHECK_THAT(lag_in_samples(a, b, 200).value(), WithinAbs(delay, 0.05));
  }
}

TEST_CASE("lag: of two peaks in one period the nearer counts", "[datasets]") {
  for (const double frequency : {0.1, 0.25, 0.31, 0.34}) {
    for (const double part : {-0.48, -0.3, 0.45, 0.48}) {
      for (const double noise : {0.0, 0.02}) {
        const double delay = part / frequency;
        CAPTURE(frequency, delay, noise);
        const auto a = sampled(sine(frequency), 2000, 0.0, noise, 7);
        const auto b = sampled(sine(frequency), 2000, delay, noise, 8);
        CHECK_THAT(lag_in_samples(a, b, 200).value(), WithinAbs(delay, 0.01));
      }
    }
  }
}

TEST_CASE("lag: a sine too fast to tell its periods apart tells nothing", "[datasets]") {
  for (const double frequency : {0.37, 0.42, 0.48}) {
    CAPTURE(frequency);
    const auto a = sampled(sine(frequency), 2000, 0.0, 0.02, 7);
    const auto b = sampled(sine(frequency), 2000, 0.3, 0.02, 8);
    CHECK_FALSE(lag_in_samples(a, b, 200).has_value());
  }
}

TEST_CASE("lag: nothing is told by constant, unrelated or far shifted records", "[datasets]") {
  const std::vector<double> constant(500, 3.1);
  const auto noise = sampled([](double) { return 0.0; }, 500, 0.0, 1.0, 5);
  const auto other = sampled([](double) { return 0.0; }, 500, 0.0, 1.0, 6);
  CHECK_FALSE(lag_in_samples(constant, noise, 20).has_value());
  CHECK_FALSE(lag_in_samples(constant, constant, 20).has_value());
  CHECK_FALSE(lag_in_samples(noise, other, 20).has_value());
  const Shape step = [](double t) { return std::tanh((t - 500.0) / 20.0); };
  CHECK_FALSE(
      lag_in_samples(sampled(step, 2000, 0.0, 0.0, 1), sampled(step, 2000, 60.0, 0.0, 1), 40));
  CHECK_FALSE(lag_in_samples({1.0, 2.0}, {1.0, 2.0}, 20).has_value());
}

TEST_CASE("lag: 1e5 samples over 200 lags", "[datasets]") {
  const auto a = sampled(soft_square(100, 3), 100000, 0.0, 0.01, 1);
  const auto b = sampled(soft_square(100, 3), 100000, 3.3, 0.01, 2);
  CHECK_THAT(lag_in_samples(a, b, 200).value(), WithinAbs(3.3, 0.005));
}

TEST_CASE("lag: unrelated noise tells none", "[datasets]") {
  const Shape nothing = [](double) { return 0.0; };
  for (unsigned draw = 0; draw < 20; ++draw) {
    CAPTURE(draw);
    CHECK_FALSE(lag_in_samples(sampled(nothing, 500, 0.0, 1.0, 100 + 2 * draw),
                               sampled(nothing, 500, 0.0, 1.0, 101 + 2 * draw), 20));
  }
}

TEST_CASE("lag: its standard deviation to a tenth", "[datasets]") {
  // The rms of 200 draws has a standard deviation of 5 %.
  double squares = 0.0;
  double variances = 0.0;
  for (unsigned draw = 0; draw < 200; ++draw) {
    const auto lag = find_lag(sampled(sine(0.02), 1000, 0.0, 0.05, 1000 + 2 * draw),
                              sampled(sine(0.02), 1000, 1.3, 0.05, 1001 + 2 * draw), 20);
    REQUIRE(lag.has_value());
    squares += (lag->samples - 1.3) * (lag->samples - 1.3);
    variances += lag->sd_samples * lag->sd_samples;
  }
  CHECK_THAT(std::sqrt(variances / squares), WithinAbs(1.0, 0.15));
}

TEST_CASE("lag: of several records at once, the same bits as of each alone", "[datasets]") {
  const auto a = sampled(soft_square(100, 3), 3000, 0.0, 0.01, 1);
  const auto b = sampled(soft_square(100, 3), 3000, 3.3, 0.01, 2);
  const auto other = sampled([](double) { return 0.0; }, 3000, 0.0, 1.0, 3);
  const auto shorter = sampled(soft_square(100, 3), 700, -7.2, 0.01, 4);
  const auto lags = find_lags(a, {&b, &other, &shorter}, 200);
  REQUIRE(lags.size() == 3);
  CHECK(lags[0].value().samples == find_lag(a, b, 200).value().samples);
  CHECK_FALSE(lags[1].has_value());
  CHECK(lags[2].value().samples == find_lag(a, shorter, 200).value().samples);
  CHECK(lags[2].value().sd_samples == find_lag(a, shorter, 200).value().sd_samples);
  CHECK(find_lags(a, {}, 200).empty());
}
