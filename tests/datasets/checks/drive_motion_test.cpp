#include "datasets/checks/drive_motion.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::WithinAbs;

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
