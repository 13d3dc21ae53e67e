#include "datasets/synthetic/noise.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace rigcal::datasets;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// Autocovariance at a lag, for a mean of zero.
double covariance(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) sum += a[i] * b[i + lag];
  return sum / static_cast<double>(a.size() - lag);
}

}  // namespace

TEST_CASE("random_stream: the same names draw the same numbers", "[datasets]") {
  auto a = random_stream(1, {"sine", "r1", "position"});
  auto b = random_stream(1, {"sine", "r1", "position"});
  CHECK(a() == b());
  CHECK(white_noise(a, 10, 1.0) == white_noise(b, 10, 1.0));
}

TEST_CASE("random_stream: another seed, name or split of names is another stream", "[datasets]") {
  const auto first = random_stream(1, {"ab", "c"})();
  CHECK(first != random_stream(2, {"ab", "c"})());
  CHECK(first != random_stream(1, {"a", "bc"})());
  CHECK(first != random_stream(1, {"ab", "d"})());
  CHECK(first != random_stream(1, {"abc"})());
  CHECK(first != random_stream(1, {"c", "ab"})());
}

TEST_CASE("random_stream: streams of neighbouring seeds are uncorrelated", "[datasets]") {
  auto a = random_stream(1, {"x"});
  auto b = random_stream(2, {"x"});
  // The mean of 20000 products with sd 1 has a standard deviation of 0.007.
  CHECK_THAT(covariance(white_noise(a, 20000, 1.0), white_noise(b, 20000, 1.0), 0),
             WithinAbs(0.0, 0.03));
}

TEST_CASE("random_stream: the numbers are fixed for all time", "[datasets]") {
  // These values were generated once by this code. A change would silently alter every synthetic
  // campaign.
  auto stream = random_stream(42, {"sine", "r1", "position"});
  CHECK(stream() == 8219953010649339831U);
  CHECK_THAT(normal(stream, 1.0), WithinAbs(-2.77589723647046, 1e-12));
}

TEST_CASE("white_noise: standard deviation, mean, no correlation", "[datasets]") {
  auto stream = random_stream(3, {"w"});
  const auto noise = white_noise(stream, 100000, 0.5);
  CHECK_THAT(std::sqrt(covariance(noise, noise, 0)), WithinRel(0.5, 0.01));
  CHECK_THAT(covariance(noise, noise, 1) / 0.25, WithinAbs(0.0, 0.015));
}

TEST_CASE("ar1_noise: stationary sd and geometric correlation", "[datasets]") {
  auto stream = random_stream(4, {"a"});
  const auto noise = ar1_noise(stream, 200000, 2.0, 0.9);
  const double variance = covariance(noise, noise, 0);
  // 200000 samples contain about 10000 independent ones.
  CHECK_THAT(std::sqrt(variance), WithinRel(2.0, 0.03));
  CHECK_THAT(covariance(noise, noise, 1) / variance, WithinAbs(0.9, 0.01));
  CHECK_THAT(covariance(noise, noise, 5) / variance, WithinAbs(std::pow(0.9, 5), 0.03));
  CHECK_THROWS_AS(ar1_noise(stream, 3, 1.0, 1.0), std::invalid_argument);
}

TEST_CASE("ar1_noise: its first sample already has the full standard deviation", "[datasets]") {
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    auto stream = random_stream(seed, {"a"});
    const double first = ar1_noise(stream, 1, 2.0, 0.99)[0];
    squares += first * first;
  }
  CHECK_THAT(std::sqrt(squares / 4000.0), WithinRel(2.0, 0.05));
}

TEST_CASE("quantised: the nearest step", "[datasets]") {
  CHECK_THAT(quantised(0.37, 0.25), WithinAbs(0.25, 1e-15));
  CHECK_THAT(quantised(0.38, 0.25), WithinAbs(0.5, 1e-15));
  CHECK_THAT(quantised(-0.38, 0.25), WithinAbs(-0.5, 1e-15));
  CHECK_THAT(quantised(-0.37, 0.25), WithinAbs(-0.25, 1e-15));
  CHECK(quantised(0.1, 0.25) == 0.0);
}

TEST_CASE("uniform: covers its range", "[datasets]") {
  auto stream = random_stream(5, {"u"});
  double low = 10.0;
  double high = -10.0;
  for (int i = 0; i < 1000; ++i) {
    const double value = uniform(stream, -2.0, 3.0);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  CHECK(low >= -2.0);
  CHECK(low < -1.9);
  CHECK(high < 3.0);
  CHECK(high > 2.9);
}
