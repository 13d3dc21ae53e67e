#include <catch2/catch.hpp>
#include <random>

#include "model/simulate.hpp"
#include "tests/model/rig.hpp"

using namespace rigcal::model;

namespace {

/// A slow sine, recorded with noise: the load pressure stays far below the supply and changes with
/// every sample.
Experiment slow_and_noisy(std::vector<Output> outputs) {
  Experiment e;
  e.times_s = grid(0.0, 2.0, 2001);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 5e-5);
  std::vector<double> reference;
  for (const double t : e.times_s)
    reference.push_back(0.05 * std::sin(2.0 * kPi * 0.1 * t) + noise(random));
  e.inputs.drive = Signal::held(e.times_s, reference);
  e.outputs = std::move(outputs);
  e.options.tolerance = 1e-7;
  return e;
}

}  // namespace

TEST_CASE("simulate: a load pressure that nobody sees takes fewer steps, and no exactness",
          "[model]") {
  Experiment e = slow_and_noisy({Output::position});
  e.free = {parameter_index(PlantKind::load_pressure, "mass"),
            parameter_index(PlantKind::load_pressure, "leakage_coefficient")};
  const Simulation hidden = e();
  e.outputs.push_back(Output::load_pressure);
  const Simulation seen = e();
  e.options.tolerance = 1e-9;
  const Simulation exact = e();
  REQUIRE(hidden.ok());
  REQUIRE(seen.ok());
  REQUIRE(exact.ok());
  CHECK(hidden.steps < 0.8 * static_cast<double>(seen.steps));
  const Eigen::VectorXd position = exact.outputs.col(0);
  const double error = peak(hidden.outputs.col(0) - position) / peak(position);
  CAPTURE(error, peak(seen.outputs.col(0) - position) / peak(position));
  CHECK(error < 1e-6);
  for (Eigen::Index j = 0; j < 2; ++j) {
    const Eigen::VectorXd by = exact.sensitivities[0].col(j);
    CHECK(peak(hidden.sensitivities[0].col(j) - by) < 1e-4 * peak(by));
  }
}

TEST_CASE("simulate: a load pressure counts by its own size where an output or the loop shows it",
          "[model]") {
  const auto steps = [](std::vector<Output> outputs, double feedback) {
    Experiment e = slow_and_noisy(std::move(outputs));
    if (feedback > 0.0) e.set("pressure_feedback", feedback);
    const Simulation run = e();
    REQUIRE(run.ok());
    return run.steps;
  };
  for (const Output output :
       {Output::force, Output::acceleration, Output::leakage_flow, Output::servo_flow}) {
    CAPTURE(output_name(output));
    CHECK(steps({Output::position, output}, 0.0) ==
          steps({Output::position, Output::load_pressure}, 0.0));
  }
  CHECK(steps({Output::velocity}, 0.0) == steps({Output::position}, 0.0));
  CHECK(steps({Output::position}, 1e-8) == steps({Output::position, Output::load_pressure}, 1e-8));
}
