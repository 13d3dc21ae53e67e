#include "datasets/draft/start_motion.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using Catch::WithinRel;
using rigcal::datasets::motion_at_start;

namespace {

constexpr double kWindow_s = 0.1;

/// Motion at the start of a function of time, sampled 1000 times at 1 kHz with a noise of 0.01.
template <typename F>
std::optional<double> motion_of(F signal) {
  std::vector<double> time_s;
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) {
    time_s.push_back(100.0 + 1e-3 * i);
    values.push_back(signal(1e-3 * i) + 0.01 * std::sin(1.7 * i * i));
  }
  return motion_at_start(time_s, values, kWindow_s);
}

}  // namespace

TEST_CASE("start_motion: rest before the first edge is no motion", "[datasets]") {
  CHECK_FALSE(motion_of([](double t) { return t < 0.2 ? 0.0 : 5.0; }).has_value());
  CHECK_FALSE(motion_of([](double) { return 0.0; }).has_value());
  // 0.7 % of the range, but well above the noise.
  CHECK_FALSE(motion_of([](double t) { return 10.0 * t + (t < 0.5 ? 0.0 : 100.0); }).has_value());
}

TEST_CASE("start_motion: a record that begins in the middle of its motion", "[datasets]") {
  const auto ramp = motion_of([](double t) { return 5.0 * t; });
  REQUIRE(ramp.has_value());
  CHECK_THAT(*ramp, WithinRel(5.0 * 0.075, 0.05));  // the middles of the quarters are 75 ms apart
  CHECK(motion_of([](double t) { return std::sin(6.28 * t); }).has_value());
  CHECK(motion_of([](double t) { return -std::exp(-t / 0.05); }).has_value());
}

TEST_CASE("start_motion: a window of too few samples tells nothing", "[datasets]") {
  const std::vector<double> time_s{0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12};
  CHECK_FALSE(motion_at_start(time_s, time_s, kWindow_s).has_value());
}

TEST_CASE("start_motion: motion is what exceeds four errors of its own", "[datasets]") {
  // Means over quarters of 25 samples of white noise with sd 1 differ with an sd of sqrt(2 / 25).
  const double error = std::sqrt(2.0 / 25.0);
  const auto told = [&](double errors) {
    int count = 0;
    for (std::uint64_t draw = 0; draw < 200; ++draw) {
      auto stream = rigcal::datasets::random_stream(draw, {"start"});
      std::vector<double> time_s;
      std::vector<double> values;
      for (int i = 0; i < 100; ++i) {
        time_s.push_back(1e-3 * i);
        // Uses two levels, so that the means of the quarters differ by exactly this much.
        values.push_back(rigcal::datasets::normal(stream, 1.0) + (i < 50 ? 0.0 : errors * error));
      }
      count += motion_at_start(time_s, values, kWindow_s) ? 1 : 0;
    }
    return count;
  };
  // At 4 errors the noise estimate has an uncertainty of 0.3 errors, so 2 and 6 are clear cases.
  CHECK(told(0.0) == 0);
  CHECK(told(2.0) < 20);
  CHECK(told(6.0) > 180);
}
