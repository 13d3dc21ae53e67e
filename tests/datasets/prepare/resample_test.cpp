#include "datasets/prepare/resample.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

std::vector<double> sine(double frequency, int samples, double shift = 0.0) {
  std::vector<double> x;
  for (int i = 0; i < samples; ++i)
    x.push_back(std::sin(2.0 * std::numbers::pi * frequency * (i + shift)));
  return x;
}

}  // namespace

TEST_CASE("shifted: whole shifts copy and leave the rest empty", "[datasets]") {
  const std::vector<double> x{1.0, 2.0, 4.0, 8.0};
  const auto y = shifted(x, 1.0, 5, Interpolator::band_limited);
  CHECK(y[0] == 2.0);
  CHECK(y[2] == 8.0);
  CHECK(std::isnan(y[3]));
  const auto z = shifted(x, -2.0, 4, Interpolator::linear);
  CHECK(std::isnan(z[1]));
  CHECK(z[2] == 1.0);
}

TEST_CASE("shifted: a band-limited record keeps its shape between samples", "[datasets]") {
  for (const double frequency : {0.05, 0.2, 0.4}) {
    CAPTURE(frequency);
    const auto y = shifted(sine(frequency, 400), 2.5, 390, Interpolator::band_limited);
    const auto expected = sine(frequency, 390, 2.5);
    for (std::size_t i = 20; i < 370; ++i) CHECK_THAT(y[i], WithinAbs(expected[i], 0.003));
  }
}

TEST_CASE("shifted: a ramp goes on to the ends", "[datasets]") {
  std::vector<double> ramp;
  for (int i = 0; i < 50; ++i) ramp.push_back(0.5 * i);
  const auto y = shifted(ramp, 0.25, 50, Interpolator::band_limited);
  CHECK_THAT(y[0], WithinAbs(0.125, 1e-3));
  CHECK_THAT(y[48], WithinAbs(24.125, 1e-3));
  CHECK(std::isnan(y[49]));
}

TEST_CASE("shifted: white noise keeps 97 % of its standard deviation", "[datasets]") {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<double> noise;
  for (int i = 0; i < 100000; ++i) noise.push_back(normal(engine));
  const auto sd = [&](Interpolator interpolator) {
    const auto y = shifted(noise, 0.5, 99990, interpolator);
    double squares = 0.0;
    for (const double value : y) squares += value * value;
    return std::sqrt(squares / static_cast<double>(y.size()));
  };
  CHECK_THAT(sd(Interpolator::band_limited), WithinAbs(0.973, 0.008));
  CHECK_THAT(sd(Interpolator::linear), WithinAbs(std::sqrt(0.5), 0.008));
}

TEST_CASE("shifted: a linear shift does not overshoot an edge", "[datasets]") {
  const auto y = shifted({0.0, 0.0, 0.0, 1.0, 1.0, 1.0}, 0.25, 5, Interpolator::linear);
  CHECK(y[1] == 0.0);
  CHECK_THAT(y[2], WithinAbs(0.25, 1e-15));
  CHECK(y[3] == 1.0);
}

TEST_CASE("shifted: an impulse becomes a sinc in a Hann window, of unit sum", "[datasets]") {
  std::vector<double> impulse(101, 0.0);
  impulse[50] = 1.0;
  const auto weight = [](double z) {
    const double angle = std::numbers::pi * z;
    return std::sin(angle) / angle * 0.5 * (1.0 + std::cos(angle / 16.0));
  };
  for (const double fraction : {0.05, 0.3, 0.5}) {
    const auto y = shifted(impulse, fraction, 101, Interpolator::band_limited);
    double sum = 0.0;
    for (int j = -15; j <= 16; ++j) sum += weight(fraction - j);
    for (int k = 20; k < 80; ++k) {
      const bool reached = k >= 34 && k <= 65;
      const double expected = reached ? weight(k + fraction - 50.0) / sum : 0.0;
      CHECK_THAT(y[static_cast<std::size_t>(k)], WithinAbs(expected, 1e-12));
    }
  }
}

TEST_CASE("shifted: between two samples a linear shift weighs them by their nearness",
          "[datasets]") {
  const auto y = shifted({1.0, 2.0, 5.0}, 0.05, 3, Interpolator::linear);
  CHECK_THAT(y[0], WithinAbs(1.05, 1e-15));
  CHECK_THAT(y[1], WithinAbs(2.15, 1e-15));
  CHECK(std::isnan(y[2]));
}
