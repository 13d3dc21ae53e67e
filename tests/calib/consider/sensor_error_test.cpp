#include "calib/consider/sensor_error.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "tests/model/rig.hpp"

namespace rigcal::calib {
namespace {

using model::Experiment;
using model::Output;

/// Change of the position's readings by a parameter of its sensor, from two simulations.
Eigen::VectorXd simulated_change(Experiment experiment, std::string_view key, double value) {
  const model::Simulation without = experiment();
  const model::Simulation with = experiment.set(key, value)();
  REQUIRE(without.ok());
  REQUIRE(with.ok());
  return with.outputs.col(0) - without.outputs.col(0);
}

std::optional<Eigen::VectorXd> change_of_readings(const Experiment& experiment,
                                                  std::string_view key, double size) {
  return sensor_error(Output::position, experiment.values,
                      model::parameter_index(experiment.values.plant, key), size,
                      experiment.times_s, experiment().outputs.col(0));
}

Experiment position_run() {
  Experiment experiment;
  experiment.outputs = {Output::position};
  experiment.times_s = model::grid(0.0, 2.0, 2001);
  experiment.options.tolerance = 1e-9;
  return experiment;
}

}  // namespace

TEST_CASE("sensor error: gain and offset act as in a simulation", "[calib]") {
  Experiment experiment = position_run();
  experiment.set("position_gain", 1.1).set("position_offset", 2e-3);
  const auto gain = change_of_readings(experiment, "position_gain", 0.01);
  REQUIRE(gain);
  CHECK((*gain - simulated_change(experiment, "position_gain", 1.11)).norm() < 1e-9 * gain->norm());
  const auto offset = change_of_readings(experiment, "position_offset", 1e-4);
  REQUIRE(offset);
  CHECK((*offset - simulated_change(experiment, "position_offset", 2.1e-3)).norm() <
        1e-9 * offset->norm());
}

TEST_CASE("sensor error: a lag acts as in a simulation", "[calib]") {
  for (const double lag_s : {0.05e-3, 0.3e-3, 3e-3}) {
    INFO("lag " << lag_s << " s");
    Experiment experiment = position_run();
    experiment.set("position_gain", 1.1).set("position_offset", 2e-3);
    SECTION("equal intervals") {}
    SECTION("every third sample is missing") {
      std::vector<double> times_s;
      for (std::size_t i = 0; i < experiment.times_s.size(); ++i)
        if (i % 3 != 2) times_s.push_back(experiment.times_s[i]);
      experiment.times_s = times_s;
    }
    const auto lag = change_of_readings(experiment, "position_lag", lag_s);
    REQUIRE(lag);
    const Eigen::VectorXd simulated = simulated_change(experiment, "position_lag", lag_s);
    CHECK((*lag - simulated).norm() < 2.0 * kLagError * simulated.norm());
  }
}

TEST_CASE("sensor error: left to a simulation where the readings do not tell", "[calib]") {
  Experiment coarse = position_run();
  coarse.inputs.drive = model::Signal::sine(0.02, 10.0);
  CHECK(change_of_readings(coarse, "position_lag", 0.3e-3));
  coarse.times_s = model::grid(0.0, 2.0, 61);  // three samples per period
  CHECK_FALSE(change_of_readings(coarse, "position_lag", 0.3e-3));
  Experiment saturated = position_run();
  saturated.set("position_maximum", 0.01);
  for (const char* key : {"position_gain", "position_offset", "position_lag"})
    CHECK_FALSE(change_of_readings(saturated, key, 1e-3));
  CHECK_FALSE(change_of_readings(position_run(), "mass", 1.0));
}

TEST_CASE("sensor error: gain and offset change a start that is a reading of the sensor",
          "[calib]") {
  Experiment experiment = position_run();
  const auto changes = [&](Output output, std::string_view key) {
    return changes_start(experiment.rig, experiment.values, output,
                         model::parameter_index(experiment.values.plant, key));
  };
  CHECK_FALSE(changes(Output::position, "position_offset"));  // starts at rest
  experiment.rig.initial = model::InitialState::given;
  CHECK(changes(Output::position, "position_gain"));
  CHECK(changes(Output::position, "position_offset"));
  CHECK_FALSE(changes(Output::position, "position_lag"));
  CHECK_FALSE(changes(Output::position, "mass"));
  CHECK_FALSE(changes(Output::force, "force_offset"));
  // Without a reading the load pressure balances the load.
  CHECK_FALSE(changes(Output::load_pressure, "load_pressure_offset"));
  experiment.set("initial_load_pressure", 1e5);
  CHECK(changes(Output::load_pressure, "load_pressure_offset"));
}

}  // namespace rigcal::calib
