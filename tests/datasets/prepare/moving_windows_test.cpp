#include "datasets/prepare/moving_windows.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

/// A cylinder in open loop that follows steps of a valve command between two stops.
struct StepTest {
  std::vector<double> time_s;
  std::vector<double> command;
  std::vector<double> position_m;
};

constexpr double kRate_hz = 1000.0;
constexpr double kStroke_m = 0.2;

/// Command: 0 for 0.1 s, +`level` until 4 s, 0 until 4.1 s, -`level` until 9 s. The piston moves at
/// 0.05 m/s per V, starting 30 ms after each step.
StepTest steps(double level) {
  StepTest test;
  double x = 0.0;
  const double speed_m_per_s = 0.05 * level;
  for (int i = 0; i < 9000; ++i) {
    const double t = i / kRate_hz;
    test.time_s.push_back(t);
    const double u = t < 0.1 ? 0.0 : t < 4.0 ? level : t < 4.1 ? 0.0 : -level;
    test.command.push_back(u);
    if (t >= 0.13 && t < 4.0) x = std::min(kStroke_m, x + speed_m_per_s / kRate_hz);
    if (t >= 4.13) x = std::max(0.0, x - speed_m_per_s / kRate_hz);
    test.position_m.push_back(x);
  }
  return test;
}

void add_noise(std::vector<double>& x, double sd, const char* name) {
  auto stream = random_stream(1, {name});
  for (double& value : x) value += normal(stream, sd);
}

std::vector<Motion> motions_of(const StepTest& test, const std::vector<double>& spread = {}) {
  return find_motions(test.time_s, test.command, test.position_m, spread);
}

}  // namespace

TEST_CASE("find_motions: from the command step to the stop, and back", "[datasets]") {
  const double level = GENERATE(1.5, 2.0, 4.0);
  const auto motions = motions_of(steps(level));
  REQUIRE(motions.size() == 2);
  // A motion ends when it has covered 99 % of its travel.
  const double travel_s = 0.99 * kStroke_m / (0.05 * level);
  CHECK_THAT(motions[0].window.start_s, WithinAbs(0.1, 1e-9));
  CHECK_THAT(motions[0].window.end_s, WithinAbs(0.13 + travel_s, 3e-3));
  CHECK(motions[0].arrived);
  CHECK_THAT(motions[0].to_m, WithinAbs(kStroke_m, 1e-9));
  CHECK_THAT(motions[1].window.start_s, WithinAbs(4.1, 1e-9));
  CHECK_THAT(motions[1].window.end_s, WithinAbs(4.13 + travel_s, 3e-3));
  CHECK_THAT(motions[1].to_m, WithinAbs(0.0, 1e-9));
}

TEST_CASE("find_motions: noise and spikes in both signals move nothing much", "[datasets]") {
  StepTest test = steps(2.0);
  add_noise(test.command, 0.02, "command");
  add_noise(test.position_m, 0.3e-3, "position");
  for (const std::size_t i : {50U, 700U, 2500U, 5000U, 8000U}) {
    test.command[i] += 5.0;
    test.position_m[i + 10] -= 0.1;
  }
  const auto motions = motions_of(test);
  REQUIRE(motions.size() == 2);
  CHECK_THAT(motions[0].window.start_s, WithinAbs(0.1, 3e-3));
  // With noise of 0.3 mm, medians of a few samples and a speed of 0.1 m/s, the error is some
  // milliseconds.
  CHECK_THAT(motions[0].window.end_s, WithinAbs(0.13 + 1.98, 0.01));
  CHECK_THAT(motions[1].window.start_s, WithinAbs(4.1, 3e-3));
  CHECK_THAT(motions[1].window.end_s, WithinAbs(4.13 + 1.98, 0.01));
}

TEST_CASE("find_motions: ends before the first repeat has arrived", "[datasets]") {
  const StepTest test = steps(2.0);
  // If the arrivals of repeats vary by 50 ms, their positions vary by 5 mm during the motion.
  const std::vector<double> spread(test.time_s.size(), 5e-3);
  const auto motions = motions_of(test, spread);
  REQUIRE(motions.size() == 2);
  CHECK_THAT(motions[0].margin_m, WithinAbs(10e-3, 1e-12));
  CHECK_THAT(motions[0].window.end_s, WithinAbs(0.13 + 1.9, 3e-3));
  const std::vector<double> unknown(test.time_s.size(), std::numeric_limits<double>::quiet_NaN());
  CHECK(motions_of(test, unknown)[0].window.end_s > motions[0].window.end_s);
}

TEST_CASE("find_motions: a motion that the next step cuts short", "[datasets]") {
  StepTest test = steps(0.8);  // the stroke takes 5 s
  const auto motions = motions_of(test);
  REQUIRE(motions.size() == 2);
  CHECK_FALSE(motions[0].arrived);
  CHECK_THAT(motions[0].window.end_s, WithinAbs(3.999, 1e-9));
}

TEST_CASE("find_motions: a record that begins with the motion", "[datasets]") {
  StepTest test = steps(2.0);
  for (auto* signal : {&test.time_s, &test.command, &test.position_m})
    signal->erase(signal->begin(), signal->begin() + 120);
  const auto motions = motions_of(test);
  REQUIRE(motions.size() == 2);
  CHECK(motions[0].window.start_s == test.time_s.front());
}

TEST_CASE("find_motions: nothing steps in a sine, a ramp or at rest", "[datasets]") {
  StepTest test = steps(2.0);
  const auto shape = GENERATE(0, 1, 2);
  for (std::size_t i = 0; i < test.time_s.size(); ++i) {
    const double t = test.time_s[i];
    test.command[i] = shape == 0 ? std::sin(6.283185307179586 * 0.5 * t) : shape == 1 ? t : 0.0;
    test.position_m[i] = 0.1 * test.command[i];
  }
  CHECK(motions_of(test).empty());
}

TEST_CASE("find_motions: a rise that takes some samples, and too short records", "[datasets]") {
  StepTest test = steps(2.0);
  for (int i = 0; i < 20; ++i) test.command[static_cast<std::size_t>(100 + i)] = 0.1 * i;
  const auto motions = motions_of(test);
  REQUIRE(motions.size() == 2);
  // The window starts when the command has changed by more than 2 % of its range.
  CHECK_THAT(motions[0].window.start_s, WithinAbs(0.101, 1.1e-3));
  CHECK(find_motions({}, {}, {}, {}).empty());
  const std::vector<double> two{0.0, 1.0};
  CHECK(find_motions(two, two, two, {}).empty());
  CHECK_THROWS_AS(find_motions(two, two, test.position_m, {}), std::invalid_argument);
}

TEST_CASE("find_motions: a step rises within a tenth of the time that it is held", "[datasets]") {
  for (const int held : {400, 700}) {
    StepTest test;
    double x = 0.0;
    for (int i = 0; i < 150 + held + 1500; ++i) {
      // 0 V, then a rise of 50 ms, then 2 V for a given number of samples, then immediately -2 V.
      const double u = i < 100 ? 0.0 : i < 150 ? 0.04 * (i - 100) : i < 150 + held ? 2.0 : -2.0;
      x += 0.05 * u / kRate_hz;
      test.time_s.push_back(i / kRate_hz);
      test.command.push_back(u);
      test.position_m.push_back(x);
    }
    CHECK(motions_of(test).size() == (held > 500 ? 2U : 1U));
  }
}
