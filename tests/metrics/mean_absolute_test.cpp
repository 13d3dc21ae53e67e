#include "metrics/mean_absolute.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

using Catch::WithinRel;
using rigcal::metrics::mean_absolute;
using rigcal::metrics::mean_absolute_slope;
using rigcal::metrics::mean_absolute_weights;

namespace {

constexpr double kRounding = 1e-14;  // relative; a few units in the last place

/// Times for one period of 1 s, both ends included.
std::vector<double> times(std::size_t intervals) {
  std::vector<double> t;
  for (std::size_t i = 0; i <= intervals; ++i) {
    t.push_back(static_cast<double>(i) / static_cast<double>(intervals));
  }
  return t;
}

std::vector<double> sine(const std::vector<double>& t, double amplitude, double phase_rad) {
  std::vector<double> y;
  for (const double x : t)
    y.push_back(amplitude * std::sin(2.0 * std::numbers::pi * x + phase_rad));
  return y;
}

}  // namespace

TEST_CASE("mean_absolute: straight lines are exact, whatever the spacing", "[metrics]") {
  CHECK_THAT(mean_absolute(std::vector{0.0, 1.0, 4.0}, std::vector{2.0, 2.0, 6.0}),
             WithinRel((2.0 + 3.0 * 4.0) / 4.0, kRounding));
  // From -1 to 3, the line is below zero for a quarter of the time: 0.25 * 0.5 + 0.75 * 1.5.
  CHECK_THAT(mean_absolute(std::vector{0.0, 2.0}, std::vector{-1.0, 3.0}),
             WithinRel(1.25, kRounding));
  CHECK(mean_absolute(std::vector{0.0, 1.0, 2.0}, std::vector{0.0, 0.0, 0.0}) == 0.0);
  // The sign changes at a sample, and this sample is zero.
  CHECK_THAT(mean_absolute(std::vector{0.0, 1.0, 2.0}, std::vector{-2.0, 0.0, 2.0}),
             WithinRel(1.0, kRounding));
}

TEST_CASE("mean_absolute: of a sine is 2/pi, with a square-law error wherever the zero falls",
          "[metrics]") {
  for (const double phase_rad : {0.0, 0.1, 0.02}) {
    const auto t = times(100);
    const double mean = mean_absolute(t, sine(t, 2.0, phase_rad));
    // The trapezoidal rule has an error of (2 pi / 100)^2 / 12 = 3.3e-4.
    CHECK_THAT(mean, WithinRel(4.0 / std::numbers::pi, 4e-4));
    CHECK(mean < 4.0 / std::numbers::pi);  // chords are inside the arc
  }
}

TEST_CASE("mean_absolute_slope: against central differences, through sign changes", "[metrics]") {
  const auto t = times(40);
  const auto y = sine(t, 2.0, 0.1);
  const auto direction = sine(t, 1.0, 1.2);
  const double h = 1e-6;
  auto ahead = y;
  auto behind = y;
  for (std::size_t i = 0; i < t.size(); ++i) {
    ahead[i] += h * direction[i];
    behind[i] -= h * direction[i];
  }
  const double difference = (mean_absolute(t, ahead) - mean_absolute(t, behind)) / (2.0 * h);
  // Rounding limits the difference to 1e-16 / 1e-6.
  CHECK_THAT(mean_absolute_slope(t, y, direction), WithinRel(difference, 1e-8));
  const auto weights = mean_absolute_weights(t, y);
  CHECK_THAT(std::inner_product(weights.begin(), weights.end(), direction.begin(), 0.0),
             WithinRel(difference, 1e-8));
  CHECK_THROWS_AS(mean_absolute_weights(t, std::vector{1.0}), std::invalid_argument);
  // Scaling a signal scales its mean.
  CHECK_THAT(mean_absolute_slope(t, y, y), WithinRel(mean_absolute(t, y), 1e-13));
  CHECK_THROWS_AS(mean_absolute_slope(t, y, std::vector{1.0}), std::invalid_argument);
}

TEST_CASE("mean_absolute: what cannot be is said", "[metrics]") {
  const std::vector<double> t{0.0, 1.0, 2.0};
  const std::vector<double> q{1.0, 2.0, 1.0};
  CHECK_THROWS_WITH(mean_absolute(t, std::vector{1.0, 2.0}),
                    Catch::Contains("3 times but 2 samples"));
  CHECK_THROWS_WITH(mean_absolute(std::vector{0.0, 1.0, 1.0}, q),
                    Catch::Contains("time_s[2] is 1 after 1"));
  CHECK_THROWS_WITH(mean_absolute(t, std::vector{1.0, std::nan(""), 1.0}), Catch::Contains("[1]"));
  CHECK_THROWS_AS(mean_absolute(std::vector{0.0}, std::vector{1.0}), std::invalid_argument);
}
