#include "datasets/prepare/decimate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// sin(2 pi f i), with f in cycles per sample.
std::vector<double> sine(double cycles_per_sample, std::size_t samples) {
  std::vector<double> x(samples);
  for (std::size_t i = 0; i < samples; ++i)
    x[i] = std::sin(2.0 * std::numbers::pi * cycles_per_sample * static_cast<double>(i));
  return x;
}

double rms_inner(const std::vector<double>& x) {
  double sum = 0.0;
  for (std::size_t i = 20; i + 20 < x.size(); ++i) sum += x[i] * x[i];
  return std::sqrt(sum / static_cast<double>(x.size() - 40));
}

Repeat sampled(double dt, std::size_t samples) {
  Repeat repeat;
  repeat.source = "a.csv";
  for (std::size_t i = 0; i < samples; ++i) repeat.time_s.push_back(dt * static_cast<double>(i));
  return repeat;
}

}  // namespace

TEST_CASE("anti_alias_filter: passes, halves and stops where it says", "[datasets]") {
  const std::size_t factor = GENERATE(2U, 5U, 10U);
  const auto filter = anti_alias_filter(factor);
  CHECK(filter.taps.size() % 2 == 1);
  const auto gain = [&](double of_new_rate) {
    double sum = 0.0;
    const auto half = static_cast<double>(filter.taps.size() / 2);
    for (std::size_t i = 0; i < filter.taps.size(); ++i)
      sum +=
          filter.taps[i] * std::cos(2.0 * std::numbers::pi * of_new_rate /
                                    static_cast<double>(factor) * (static_cast<double>(i) - half));
    return sum;
  };
  CHECK_THAT(gain(0.0), WithinAbs(1.0, 1e-12));
  for (const double f : {0.05, 0.2, 0.35, 0.4}) CHECK_THAT(gain(f), WithinAbs(1.0, 1.1e-3));
  CHECK_THAT(gain(0.5), WithinAbs(0.5, 5e-3));
  for (const double f : {0.6, 0.7, 0.9, 1.0}) CHECK_THAT(gain(f), WithinAbs(0.0, 1.1e-3));
  CHECK_THROWS_AS(anti_alias_filter(1), std::invalid_argument);
}

TEST_CASE("decimated: no delay in the pass band, no alias from the stop band", "[datasets]") {
  const auto filter = anti_alias_filter(10);
  const auto slow = decimated(sine(0.02, 5001), filter);
  REQUIRE(slow.size() == 501);
  const auto expected = sine(0.2, 501);
  for (std::size_t k = 30; k < 470; ++k) CHECK_THAT(slow[k], WithinAbs(expected[k], 2e-3));
  // 0.09 cycles per sample would alias to 0.1 at the new rate.
  CHECK(rms_inner(decimated(sine(0.09, 5001), filter)) < 1e-3);
  std::vector<double> ramp(201);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  const auto line = decimated(ramp, anti_alias_filter(4));
  for (std::size_t k = 0; k < line.size(); ++k)
    CHECK_THAT(line[k], WithinAbs(4.0 * static_cast<double>(k), 1e-9));
}

TEST_CASE("decimated: leaves white noise the sd that noise_gain says", "[datasets]") {
  auto stream = random_stream(7, {"decimate"});
  const auto filter = anti_alias_filter(5);
  const double left = rms_inner(decimated(white_noise(stream, 100'000, 2.0), filter));
  // There are 20 000 almost uncorrelated samples, so the standard error is 0.5 %.
  CHECK_THAT(left, WithinRel(2.0 * filter.noise_gain(), 0.02));
  CHECK_THAT(filter.noise_gain(), WithinRel(1.0 / std::sqrt(5.0), 0.05));
}

TEST_CASE("decimated_hold: a held command keeps its integral and its edges", "[datasets]") {
  const std::vector<double> u{0.1, 0.1, 0.1, 0.1, 0.1, 0.3, 0.3, 0.3, 0.3, 0.3};
  CHECK(decimated_hold(u, 2)[0] == 0.1);
  CHECK_THAT(decimated_hold(u, 2)[2], WithinAbs(0.2, 1e-15));
  CHECK(decimated_hold(u, 5) == std::vector<double>{0.1, 0.3});
  CHECK(decimated_hold({1, 2, 6}, 2) == std::vector<double>{1.5, 6});
}

TEST_CASE("decimation_factor: whole factors of even sampling only", "[datasets]") {
  CHECK(decimation_factor(sampled(1e-4, 100), 1000.0) == 10);
  CHECK(decimation_factor(sampled(1e-3, 100), 1000.0) == 1);
  CHECK(decimation_factor(sampled(1e-2, 100), 1000.0) == 1);
  CHECK_THROWS_WITH(decimation_factor(sampled(1e-4, 100), 3000.0),
                    Contains("a.csv is sampled at 10000 Hz") && Contains("3.333 times") &&
                        Contains("2500 Hz or 3333.33 Hz"));
  Repeat uneven = sampled(1e-4, 100);
  uneven.time_s[50] += 0.5e-4;
  CHECK_THROWS_WITH(decimation_factor(uneven, 1000.0),
                    Contains("not equidistant (sample 50 at 0.00505 s)"));
}

TEST_CASE("decimation_factor: whole to a hundredth", "[datasets]") {
  CHECK(decimation_factor(sampled(1e-3 / 5.04, 100), 1000.0) == 5);
  CHECK_THROWS_WITH(decimation_factor(sampled(1e-3 / 5.06, 100), 1000.0), Contains("whole factor"));
}

TEST_CASE("decimated_hold: a constant stays what it is to the last bit", "[datasets]") {
  // In floating point, 0.1 + 0.1 + 0.1 is more than 0.3.
  CHECK(decimated_hold({0.1, 0.1, 0.1}, 3) == std::vector<double>{0.1});
}
