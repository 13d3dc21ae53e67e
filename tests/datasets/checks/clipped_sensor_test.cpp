#include "datasets/checks/clipped_sensor.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;

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
