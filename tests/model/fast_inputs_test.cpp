#include <catch2/catch.hpp>

#include "model/simulate.hpp"
#include "tests/model/rig.hpp"

using namespace rigcal::model;
using Catch::Contains;
using Catch::WithinRel;

namespace {

Experiment driven_by(const Signal& drive, double seconds, int samples) {
  Experiment e;
  e.inputs.drive = drive;
  e.times_s = grid(0.0, seconds, samples);
  return e;
}

}  // namespace

TEST_CASE("simulate: an input faster than instants can be told apart fails at once", "[model]") {
  for (const double frequency_hz : {1e12, 1e20, 1e30, 1e300}) {
    CAPTURE(frequency_hz);
    for (const Signal& drive :
         {Signal::square(0.005, frequency_hz), Signal::sine(0.005, frequency_hz),
          Signal::chirp(0.005, 1.0, frequency_hz, 1.0, false)}) {
      Experiment e = driven_by(drive, 2.0, 401);
      Simulation run = e();
      CHECK(run.status == SimulationStatus::step_too_small);
      CHECK_THAT(run.reason, Contains("faster than its sample times"));
      e.inputs.drive = Signal::constant(0.0);
      e.inputs.supply_pressure_pa = drive;
      CHECK(e().status == SimulationStatus::step_too_small);
    }
  }
}

TEST_CASE("simulate: a sample many half periods after the one before finds its segment",
          "[model]") {
  Experiment e = driven_by(Signal::square(0.001, 100.0), 1.0, 3);
  e.options.periodic_steady_state = false;
  const Simulation run = e();
  REQUIRE(run.ok());
  Experiment fine = driven_by(Signal::square(0.001, 100.0), 1.0, 201);
  fine.options.periodic_steady_state = false;
  const Simulation other = fine();
  REQUIRE(other.ok());
  CHECK_THAT(run.outputs(2, 0), WithinRel(other.outputs(200, 0), 1e-4));
}
