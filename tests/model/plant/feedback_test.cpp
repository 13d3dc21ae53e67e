// Tests loops on position, force, load pressure and acceleration, and the inner feedback of the
// load pressure (docs/model.md).

#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/layout.hpp"
#include "model/plant/load_pressure.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

struct Loop {
  Feedback feedback;
  Output controlled;
  double amplitude;
  double kp, ki;  ///< low gains
};
constexpr Loop kLoops[] = {{Feedback::position, Output::position, 0.01, 80.0, 400.0},
                           {Feedback::force, Output::force, 2e3, 5e-5, 1e-3},
                           {Feedback::load_pressure, Output::load_pressure, 1e6, 8e-8, 2e-6},
                           {Feedback::acceleration, Output::acceleration, 20.0, 9e-3, 0.1}};

Experiment loop_on(const Loop& loop, Experiment e = {}) {
  e.rig.feedback = loop.feedback;
  e.values.given[static_cast<std::size_t>(parameter_index(e.rig.plant, "kp"))] = false;
  e.set(gain_keys(loop.feedback).kp, loop.kp);
  e.inputs.drive = Signal::sine(loop.amplitude, 3.0);
  e.times_s = grid(0.0, 0.5, 101);
  e.outputs = {Output::command, loop.controlled, Output::load_pressure};
  e.options.tolerance = 1e-8;
  return e;
}

double reference(const Loop& loop, double t) {
  return loop.amplitude * std::sin(2.0 * kPi * 3.0 * t);
}

}  // namespace

TEST_CASE("feedback: the command is the gain times what the controlled quantity lacks", "[model]") {
  for (const Loop& loop : kLoops) {
    for (const Experiment& rig : {Experiment{}, two_chamber_rig()}) {
      const Experiment e = loop_on(loop, rig);
      const Simulation run = e();
      INFO(run.reason);
      REQUIRE(run.ok());
      double largest = 0.0;
      for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
        const double error =
            reference(loop, e.times_s[static_cast<std::size_t>(i)]) - run.outputs(i, 1);
        CHECK_THAT(run.outputs(i, 0), WithinAbs(loop.kp * error, 1e-9));
        largest = std::max(largest, std::abs(run.outputs(i, 0)));
      }
      CHECK(largest > 0.01);
    }
  }
}

TEST_CASE("feedback: the load pressure is fed back inside the loop", "[model]") {
  for (const Loop& loop : kLoops) {
    Experiment e = loop_on(loop);
    e.set("pressure_feedback", 3e-8).set("valve_time_constant", 2e-3);
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
      const double error =
          reference(loop, e.times_s[static_cast<std::size_t>(i)]) - run.outputs(i, 1);
      CHECK_THAT(run.outputs(i, 0), WithinAbs(loop.kp * error - 3e-8 * run.outputs(i, 2), 1e-9));
    }
  }
}

TEST_CASE("feedback: pressure feedback damps what rings", "[model]") {
  Experiment e;
  e.set("damping", 100.0).set("leakage_coefficient", 0.0);
  e.inputs.drive = Signal::square(0.002, 1.0);
  e.times_s = grid(0.1, 0.12, 41);
  e.times_s.insert(e.times_s.begin(), 0.0);
  e.outputs = {Output::acceleration};
  const double rings = peak(e().outputs);
  e.set("pressure_feedback", 2e-7);
  CHECK(peak(e().outputs) < 0.2 * rings);
}

TEST_CASE("feedback: integral action leaves no error of force and load pressure", "[model]") {
  for (const Loop& loop : kLoops) {
    if (loop.feedback == Feedback::acceleration) continue;  // it lags, because of the damper
    Experiment e = loop_on(loop);
    e.set("stiffness", 3e5).set("damping", 2e4).set(gain_keys(loop.feedback).ki, 20.0 * loop.ki);
    e.inputs.drive = Signal::constant(0.5 * loop.amplitude);
    e.times_s = {0.0, 20.0};
    e.outputs = {loop.controlled, Output::position, Output::force};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    CAPTURE(gain_keys(loop.feedback).name);
    CHECK_THAT(run.outputs(1, 0), WithinRel(0.5 * loop.amplitude, 1e-4));
    CHECK_THAT(3e5 * run.outputs(1, 1), WithinRel(run.outputs(1, 2), 1e-4));
  }
}

TEST_CASE("feedback: a given state starts with the integral that it is told", "[model]") {
  Experiment e;
  e.rig.initial = InitialState::given;
  e.set("ki", 300.0).set("initial_integral", 0.7).set("initial_position", 0.01);
  e.inputs.drive = Signal::constant(0.0);
  e.outputs = {Output::command};
  e.times_s = {0.0, 0.1};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(0, 0), WithinRel(0.7 - 78.74 * 0.01, 1e-12));
}

TEST_CASE("layout_of: a loop takes the gains and the filter of what it controls", "[model]") {
  ParameterValues values = paper_rig();
  for (const char* key : {"ki", "force_ki", "force_kd", "derivative_filter"}) values.set(key, 1.0);
  Rig rig;
  rig.feedback = Feedback::force;
  const Layout force = layout_of(rig, values, {}, 3);
  CHECK(force.states == 5);
  CHECK(force.filter == 4);
  CHECK(force.added[1]->unit == "N");
  CHECK_FALSE(force.position_alone());
  rig.feedback = Feedback::load_pressure;
  CHECK(layout_of(rig, values, {}, 3).states == 3);
  rig.feedback = Feedback::position;
  CHECK(layout_of(rig, values, {}, 3).states == 4);
  CHECK(layout_of(rig, values, {}, 3).position_alone());
  values.set("pressure_feedback", 1e-8);
  CHECK_FALSE(layout_of(rig, values, {}, 3).position_alone());
}

TEST_CASE("layout_of: every state has a floor of its own", "[model]") {
  ParameterValues values = paper_rig();
  for (const char* key : {"payload_mass", "valve_frequency", "ki"}) values.set(key, 1.0);
  const Layout layout = layout_of({}, values, {}, 3);
  REQUIRE(layout.states == 8);
  CHECK(layout.payload == 3);
  const auto floors = state_floors<LoadPressurePlant, 10>(layout);
  CHECK(floors == std::array<double, 10>{1e-6, 1e-5, 100.0, 1e-6, 1e-5, 1e-3, 1.0, 1e-3, 1.0, 1.0});
}
