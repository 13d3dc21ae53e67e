#include "metrics/residual_features.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::metrics::residual_features;

namespace {

constexpr double kFeatureRounding = 1e-14;  // relative; a few units in the last place

}  // namespace

TEST_CASE("residual_features: by hand", "[metrics]") {
  // |r| = 1, 2, 2, 3 has mean 2, mean square 18/4 and variance 1/2.
  const auto f = residual_features(std::vector{1.0, -2.0, 2.0, -3.0});
  CHECK_THAT(f.mean, WithinRel(2.0, kFeatureRounding));
  CHECK_THAT(f.rms, WithinRel(std::sqrt(4.5), kFeatureRounding));
  CHECK_THAT(f.std, WithinRel(std::sqrt(0.5), kFeatureRounding));
}

TEST_CASE("residual_features: a sine over whole periods has 2/pi, 1/sqrt(2) and their difference",
          "[metrics]") {
  constexpr double kPi = std::numbers::pi;
  const std::size_t n = 100'000;
  std::vector<double> r(n);
  for (std::size_t i = 0; i < n; ++i) {
    r[i] = 3.0 * std::sin(2.0 * kPi * 5.0 * (static_cast<double>(i) + 0.5) / 1e5);
  }
  const auto f = residual_features(r);
  // The relative error of the midpoint rule in the mean is the square of the phase step, (2 pi 5 /
  // 1e5)^2 / 24 = 4e-9. The standard deviation is a difference, so its error is ten times as large.
  CHECK_THAT(f.mean, WithinRel(6.0 / kPi, 1e-8));
  CHECK_THAT(f.rms, WithinRel(3.0 / std::sqrt(2.0), 1e-8));
  CHECK_THAT(f.std, WithinRel(3.0 * std::sqrt(0.5 - 4.0 / (kPi * kPi)), 1e-7));
}

TEST_CASE("residual_features: sign does not count, scale does, and a constant has no spread",
          "[metrics]") {
  const std::vector<double> r{0.3, -0.1, 0.7, -0.9, 0.2};
  std::vector<double> other;
  for (const double value : r) other.push_back(-1e6 * value);
  const auto f = residual_features(r);
  const auto g = residual_features(other);
  CHECK_THAT(g.mean, WithinRel(1e6 * f.mean, kFeatureRounding));
  CHECK_THAT(g.rms, WithinRel(1e6 * f.rms, kFeatureRounding));
  CHECK_THAT(g.std, WithinRel(1e6 * f.std, kFeatureRounding));
  CHECK_THAT(f.std * f.std, WithinRel(f.rms * f.rms - f.mean * f.mean, 1e-12));

  const auto constant = residual_features(std::vector{0.1, -0.1, 0.1});
  CHECK(constant.std == 0.0);
  CHECK_THAT(constant.mean, WithinAbs(0.1, 1e-16));
}

TEST_CASE("residual_features: bad input is named", "[metrics]") {
  CHECK_THROWS_WITH(residual_features(std::vector{1.0}),
                    Catch::Contains("residual_features") && Catch::Contains("1 samples"));
  CHECK_THROWS_WITH(residual_features(std::vector{1.0, std::nan("")}),
                    Catch::Contains("residual[1]"));
  CHECK_THROWS_AS(residual_features(std::vector{1.0, HUGE_VAL}), std::invalid_argument);
}
