#include "datasets/prepare/lag_sums.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

std::vector<double> noise(std::size_t samples, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(samples);
  for (double& value : x) value = normal(engine);
  return x;
}

double product(const std::vector<double>& fixed, const std::vector<double>& moving,
               std::size_t shift) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fixed.size() && i + shift < moving.size(); ++i)
    sum += fixed[i] * moving[i + shift];
  return sum;
}

}  // namespace

TEST_CASE("lag sums: products at every shift, whatever the lengths", "[datasets]") {
  for (const std::size_t longer : {0U, 1U, 2U, 3U, 17U}) {
    for (const std::size_t samples : {5U, 64U, 65U, 66U, 67U, 200U}) {
      for (const bool moving_is_longer : {false, true}) {
        const auto fixed = noise(samples + (moving_is_longer ? 0 : longer), 1);
        const auto moving = noise(samples + (moving_is_longer ? longer : 0), 2);
        for (const int first : {0, 1, 3}) {
          const int last = std::min(40, static_cast<int>(moving.size()) - 1);
          CAPTURE(longer, samples, moving_is_longer, first);
          const auto sums = shifted_products(fixed, moving, first, last);
          REQUIRE(sums.size() == static_cast<std::size_t>(last - first + 1));
          for (std::size_t k = 0; k < sums.size(); ++k)
            REQUIRE_THAT(
                sums[k],
                WithinAbs(product(fixed, moving, static_cast<std::size_t>(first) + k), 1e-12));
        }
      }
    }
  }
}

TEST_CASE("lag sums: a product does not depend on those beside it", "[datasets]") {
  const auto fixed = noise(301, 3);
  const auto moving = noise(303, 4);
  const auto together = shifted_products(fixed, moving, 0, 37);
  for (int k = 0; k <= 37; ++k) {
    CAPTURE(k);
    CHECK(shifted_products(fixed, moving, k, k).front() == together[static_cast<std::size_t>(k)]);
  }
}

TEST_CASE("lag sums: weighted sums, each added up from its first weight on", "[datasets]") {
  for (const std::size_t taps : {1U, 2U, 7U, 193U}) {
    for (const std::size_t samples : {193U, 200U, 208U, 224U, 500U}) {
      const auto x = noise(samples, 5);
      const auto kernel = noise(taps, 6);
      CAPTURE(taps, samples);
      const auto sums = weighted_sums(x, kernel);
      REQUIRE(sums.size() == samples - taps + 1);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        double expected = 0.0;
        for (std::size_t j = 0; j < taps; ++j) expected += kernel[j] * x[i + j];
        REQUIRE(sums[i] == expected);
      }
    }
  }
  CHECK(weighted_sums(noise(3, 7), noise(4, 8)).empty());
  CHECK(weighted_sums(noise(3, 7), {}).empty());
}
