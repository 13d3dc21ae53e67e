#include "datasets/checks/frozen_sensor.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;

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
