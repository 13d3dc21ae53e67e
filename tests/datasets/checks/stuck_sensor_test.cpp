#include "datasets/checks/stuck_sensor.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::WithinAbs;

namespace {

std::size_t clipped_samples(const Samples& x, const Samples& drive, RangeEnd end) {
  std::size_t sum = 0;
  for (const EqualRun& run : clipped_runs(x, drive, end)) sum += run.length;
  return sum;
}

std::size_t both_ends(const Samples& x, const Samples& drive) {
  return clipped_samples(x, drive, RangeEnd::lowest) + clipped_samples(x, drive, RangeEnd::highest);
}

}  // namespace

TEST_CASE("clipped_runs: a sine that is clipped, with noise and without", "[datasets]") {
  for (const double period : {20.0, 100.0, 1000.0}) {
    for (const double level : {0.8, 0.95}) {
      for (const double noise : {0.0, 0.002}) {
        CAPTURE(period, level, noise);
        const Samples drive = sine_signal(4000, period);
        const Samples whole = with_noise(sine_signal(4000, period), noise);
        const Samples cut = clipped(whole, -2.0, level);
        const auto beyond = static_cast<std::size_t>(
            std::count_if(whole.begin(), whole.end(), [&](double v) { return v >= level; }));
        const std::size_t found = clipped_samples(cut, drive, RangeEnd::highest);
        // All of it is found except the edges. At 20 samples per period, a level of 0.95 leaves two
        // samples each, which no rule can distinguish from coincidence.
        if (period > 20.0 || level < 0.9) {
          CHECK(found <= beyond);
          CHECK(static_cast<double>(found) > 0.8 * static_cast<double>(beyond));
        }
        CHECK(clipped_samples(cut, drive, RangeEnd::lowest) == 0);
      }
    }
  }
}

TEST_CASE("clipped_runs: both ends, and behind a converter", "[datasets]") {
  const Samples drive = sine_signal(4000, 200.0);
  const Samples cut = quantised(clipped(sine_signal(4000, 200.0), -0.7, 0.9), 0.001);
  CHECK(clipped_samples(cut, drive, RangeEnd::lowest) > 0);
  CHECK(clipped_samples(cut, drive, RangeEnd::highest) > 0);
}

TEST_CASE("clipped_runs: at rest, noise of which one side is cut away", "[datasets]") {
  // A piston is on its stop for most of the record, at the end of the converter's range.
  const Samples drive = square_signal(4000, 1000.0);
  const Samples stop = with_noise(lagged(drive, 30.0), 0.005);
  CHECK(clipped_samples(quantised(clipped(stop, -2.0, 0.998), 0.001), drive, RangeEnd::highest) >
        100);
  CHECK(both_ends(quantised(stop, 0.001), drive) == 0);
}

TEST_CASE("clipped_runs: nothing of what is whole", "[datasets]") {
  for (const double step : {1e-6, 1e-4, 0.002, 0.02, 0.1}) {
    for (const double noise : {0.0, 0.1 * step, 0.5 * step, 2.0 * step, 10.0 * step}) {
      CAPTURE(step, noise);
      for (const double period : {12.0, 20.0, 100.0, 1000.0, 5000.0}) {
        CAPTURE(period);
        const Samples drive = sine_signal(10000, period);
        CHECK(both_ends(quantised(with_noise(drive, noise), step), drive) == 0);
        // Delayed by an eighth of a period.
        const Samples late = samples(10000, [&](double i) {
          return std::sin(2.0 * std::numbers::pi * (i / period - 0.125));
        });
        CHECK(both_ends(quantised(with_noise(late, noise), step), drive) == 0);
      }
      // Square waves, followed slowly or within a sample.
      for (const double tau : {0.1, 1.0, 3.0, 30.0}) {
        CAPTURE(tau);
        const Samples drive = square_signal(10000, 500.0);
        CHECK(both_ends(quantised(with_noise(lagged(drive, tau), noise), step), drive) == 0);
      }
      // A ramp that stays constant at both ends.
      const Samples ramps = clipped(
          samples(
              10000,
              [](double i) { return 3.0 * std::abs(std::fmod(i, 1000.0) / 500.0 - 1.0) - 1.5; }),
          -1.0, 1.0);
      CHECK(both_ends(quantised(with_noise(lagged(ramps, 5.0), noise), step), ramps) == 0);
    }
  }
}

TEST_CASE("clipped_runs: what hums while it moves and is quiet at rest is whole", "[datasets]") {
  const Samples drive = square_signal(10000, 500.0);
  const Samples slow = lagged(drive, 30.0);
  const Samples hum = with_noise(Samples(10000, 0.0), 1.0);
  Samples x(10000);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = slow[i] + 0.05 * std::abs(drive[i] - slow[i]) * hum[i];
  CHECK(both_ends(quantised(x, 0.002), drive) == 0);
}

TEST_CASE("clipped_runs: a constant signal and a drive of another length say nothing",
          "[datasets]") {
  CHECK(both_ends(Samples(100, 1.0), sine_signal(100, 20.0)) == 0);
  CHECK(both_ends(clipped(sine_signal(4000, 200.0), -0.5, 0.5), sine_signal(3999, 200.0)) == 0);
}

namespace {

/// Repeats the value of sample `begin` for `length` samples.
Samples frozen(Samples x, std::size_t begin, std::size_t length) {
  std::fill_n(x.begin() + static_cast<std::ptrdiff_t>(begin), length, x[begin]);
  return x;
}

}  // namespace

TEST_CASE("frozen_runs: a stretch of a noisy signal, wherever it is", "[datasets]") {
  const Samples drive = sine_signal(4000, 400.0);
  const Samples x = with_noise(drive, 0.005);
  CHECK(frozen_runs(x, drive).empty());
  for (const std::size_t begin : {0U, 700U, 3900U}) {
    const auto runs = frozen_runs(frozen(x, begin, 100), drive);
    REQUIRE(runs.size() == 1);
    CHECK(runs[0].begin == begin);
    CHECK(runs[0].length == 100);
  }
  const Samples fast = sine_signal(4000, 100.0);
  const Samples answer = with_noise(fast, 0.05);
  CHECK(frozen_runs(frozen(answer, 700, 17), fast).size() == 1);
  CHECK(frozen_runs(frozen(answer, 700, 15), fast).empty());
}

TEST_CASE("frozen_runs: a quiet signal, while the drive goes there and back", "[datasets]") {
  const Samples drive = sine_signal(4000, 400.0);
  const Samples x = quantised(drive, 0.001);
  CHECK(frozen_runs(x, drive).empty());
  CHECK(frozen_runs(frozen(x, 1010, 1000), drive).size() == 1);
  CHECK(frozen_runs(frozen(x, 2010, 1990), drive).size() == 1);  // until the end of the record
  CHECK(frozen_runs(frozen(x, 1010, 100), drive).empty());       // a piston may stick for as long
}

TEST_CASE("frozen_runs: nothing where the rig may be at rest", "[datasets]") {
  const Samples held = square_signal(4000, 1000.0);
  const Samples x = with_noise(lagged(held, 30.0), 0.005);
  CHECK(frozen_runs(frozen(x, 600, 300), held).empty());
  CHECK(frozen_runs(frozen(x, 600, 600), held).size() == 1);  // across an edge
  // Quiet square waves, coarse and slow signals, repeated samples, and friction.
  CHECK(frozen_runs(quantised(lagged(held, 5.0), 0.001), held).empty());
  const Samples slow = sine_signal(40000, 20000.0);
  for (const double step : {0.001, 0.02, 0.2})
    for (const double noise : {0.0, 0.1, 0.5})
      CHECK(frozen_runs(quantised(with_noise(slow, noise * step), step), slow).empty());
  const Samples noise = with_noise(sine_signal(400, 40.0), 0.005);
  const Samples every_tenth =
      samples(4000, [&](double i) { return noise[static_cast<std::size_t>(i) / 10]; });
  CHECK(frozen_runs(every_tenth, sine_signal(4000, 400.0)).empty());
  const Samples sticks = samples(4000, [](double i) {
    return 0.2 * std::round(5.0 * std::sin(2.0 * std::numbers::pi * i / 1000.0));
  });
  CHECK(frozen_runs(sticks, sine_signal(4000, 1000.0)).empty());
}

TEST_CASE("frozen_runs: a sweep whose answer dies away below a step", "[datasets]") {
  const Samples drive = samples(20000, [](double i) { return std::sin(2e-6 * i * i); });
  const Samples answer =
      samples(20000, [](double i) { return std::sin(2e-6 * i * i - 1.0) * std::exp(-i / 1500.0); });
  CHECK(frozen_runs(quantised(answer, 0.01), drive).empty());
}

TEST_CASE("frozen_runs: a constant signal and a drive of another length say nothing",
          "[datasets]") {
  CHECK(frozen_runs(Samples(100, 1.0), sine_signal(100, 20.0)).empty());
  const Samples drive = sine_signal(4000, 400.0);
  const Samples x = frozen(with_noise(drive, 0.005), 700, 100);
  CHECK(frozen_runs(x, Samples(drive.begin(), drive.end() - 1)).empty());
}

TEST_CASE("drive_motion: share of the drive's range that it passes in a run", "[datasets]") {
  const Samples ramp = samples(101, [](double i) { return 10.0 * i; });
  // The run is split into four parts of ten samples. Their medians are those at samples 14.5
  // to 44.5, 30 % of the range of the ramp apart.
  CHECK_THAT(drive_motion(ramp, {10, 40, 0.0}), WithinAbs(0.30, 1e-12));
  CHECK_THAT(drive_motion(ramp, {10, 5, 0.0}), WithinAbs(0.04, 1e-12));  // too short to be divided
  CHECK(drive_motion(Samples(50, 2.0), {10, 20, 0.0}) == 0.0);
  // A constant drive does not move. The piston has had no time to respond to an edge in the last
  // tenth.
  const Samples held = square_signal(200, 100.0);
  CHECK(drive_motion(held, {50, 50, 0.0}) == 0.0);
  CHECK(drive_motion(held, {55, 50, 0.0}) == 0.0);
  CHECK(drive_motion(held, {70, 50, 0.0}) == 1.0);
}

TEST_CASE("drive_passages: from one end of the range to the other", "[datasets]") {
  const Samples drive = sine_signal(400, 100.0);
  CHECK(drive_passages(drive, {0, 30, 0.0}) == 0);
  CHECK(drive_passages(drive, {0, 80, 0.0}) == 1);
  CHECK(drive_passages(drive, {20, 110, 0.0}) == 2);
  CHECK(drive_passages(Samples(50, 2.0), {0, 50, 0.0}) == 0);
}
