// Tests loops on position, force, load pressure and acceleration, and the inner feedback of the
// load pressure, also against an integrator of another kind (docs/model.md, section 3).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/layout.hpp"
#include "model/plant/load_pressure.hpp"
#include "tests/model/both_methods.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

struct Loop {
  Feedback feedback;
  Output controlled;
  double amplitude;
  double kp, ki, kd;  ///< low gains
};
constexpr Loop kLoops[] = {{Feedback::position, Output::position, 0.01, 80.0, 400.0, 0.3},
                           {Feedback::force, Output::force, 2e3, 5e-5, 1e-3, 5e-8},
                           {Feedback::load_pressure, Output::load_pressure, 1e6, 8e-8, 2e-6, 8e-11},
                           {Feedback::acceleration, Output::acceleration, 20.0, 9e-3, 0.1, 1e-5}};

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

constexpr double kLoopFilter_rad_per_s = 300.0;
constexpr double kInnerFeedback_v_per_pa = 3e-8;
constexpr double kLoopValveLag_s = 2e-3;

/// loop_on() with all gains, inner feedback and a valve that lags.
Experiment whole_loop(const Loop& loop, const Experiment& rig) {
  Experiment e = loop_on(loop, rig);
  e.set(gain_keys(loop.feedback).ki, loop.ki).set(gain_keys(loop.feedback).kd, loop.kd);
  e.set("derivative_filter", kLoopFilter_rad_per_s);
  e.set("pressure_feedback", kInnerFeedback_v_per_pa);
  e.set("valve_time_constant", kLoopValveLag_s);
  e.times_s = grid(0.0, 0.6, 13);
  return e;
}

/// Command of whole_loop(), stated for the tests.
double own_command(const Loop& loop, double error, double integral, double filtered_error,
                   double load_pressure_pa) {
  return loop.kp * error + integral + loop.kd * kLoopFilter_rad_per_s * (error - filtered_error) -
         kInnerFeedback_v_per_pa * load_pressure_pa;
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

TEST_CASE("feedback: a loop on any quantity follows an integrator of another kind", "[model]") {
  for (const Loop& loop : kLoops) {
    Experiment e = whole_loop(loop, {});
    e.set("stiffness", 1e5).set("damping", 3000.0).set("leakage_coefficient", 0.0);
    e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::command};
    CAPTURE(gain_keys(loop.feedback).name);
    using Point = std::array<double, 6>;  // ..., load pressure, valve, integral, filtered error
    const auto acceleration = [](const Point& x) {
      return (1.62e-3 * x[2] - 3000.0 * x[1] - 1e5 * x[0]) / 85.0;
    };
    const auto error = [&](const Point& x, double t) {
      switch (loop.feedback) {
        case Feedback::force:
          return reference(loop, t) - 1.62e-3 * x[2];
        case Feedback::load_pressure:
          return reference(loop, t) - x[2];
        case Feedback::acceleration:
          return reference(loop, t) - acceleration(x);
        default:
          return reference(loop, t) - x[0];
      }
    };
    const auto command = [&](const Point& x, double t) {
      return own_command(loop, error(x, t), x[4], x[5], x[2]);
    };
    const auto rates = [&](const Point& x, double t) {
      const double head = 6.2e6 - std::copysign(x[2], x[3] * x[2]);
      const double flow = 0.6 * 0.02075 * 0.0406e-3 * x[3] * rounded_root(head) / std::sqrt(847.0);
      return Point{x[1],
                   acceleration(x),
                   4.0 * 689e6 / 2.46888e-4 * (flow - 1.62e-3 * x[1]),
                   (command(x, t) - x[3]) / kLoopValveLag_s,
                   loop.ki * error(x, t),
                   kLoopFilter_rad_per_s * (error(x, t) - x[5])};
    };
    const Eigen::MatrixXd states = runge_kutta(Point{}, e.times_s, 4000, rates);
    const Eigen::MatrixXd other = with_command<Point>(states, e.times_s, command);
    REQUIRE(peak(other.col(3)) > 0.03);
    REQUIRE(peak(other.col(3)) < 10.0);  // below the limit
    check_both_methods(e, other);
  }
}

TEST_CASE("feedback: a loop of unequal areas follows an integrator of another kind", "[model]") {
  for (const Loop& loop :
       {Loop{Feedback::position, Output::position, 0.02, 60.0, 100.0, 0.2},
        Loop{Feedback::force, Output::force, 8e3, 2e-4, 2e-3, 1e-6},
        Loop{Feedback::load_pressure, Output::load_pressure, 2.5e6, 6e-7, 6e-7, 1e-9},
        Loop{Feedback::acceleration, Output::acceleration, 4.0, 0.4, 4.0, 2e-3}}) {
    CAPTURE(gain_keys(loop.feedback).name);
    Experiment rig = proportional_rig();
    rig.rig.controller = ControllerKind::pid;
    rig.set("stiffness", 2e5).set("valve_dead_band", 0.0).set("output_limit", 10.0);
    Experiment e = whole_loop(loop, rig);
    e.outputs = {Output::position, Output::velocity, Output::pressure_a, Output::pressure_b,
                 Output::command};
    const Simulation start = e();
    INFO(start.reason);
    REQUIRE(start.ok());
    using Point = std::array<double, 7>;  // ..., both pressures, valve, integral, filtered error
    const auto acceleration = [](const Point& x) {
      return (4e-3 * x[2] - 2.4e-3 * x[3] - 4e4 * x[1] - 2e5 * x[0]) / 2000.0;
    };
    const auto error = [&](const Point& x, double t) {
      switch (loop.feedback) {
        case Feedback::force:
          return reference(loop, t) - (4e-3 * x[2] - 2.4e-3 * x[3]);
        case Feedback::load_pressure:
          return reference(loop, t) - (x[2] - x[3]);
        case Feedback::acceleration:
          return reference(loop, t) - acceleration(x);
        default:
          return reference(loop, t) - x[0];
      }
    };
    const auto command = [&](const Point& x, double t) {
      return own_command(loop, error(x, t), x[5], x[6], x[2] - x[3]);
    };
    const auto rates = [&](const Point& x, double t) {
      const auto edge = [](double signal, double head_pa) {
        const double opening = 2e-6 * std::max(signal, 0.0);
        return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening * rounded_root(head_pa);
      };
      const double flow_a = edge(x[4], 2e7 - x[2]) - edge(-x[4], x[2] - 2e5);
      const double flow_b = edge(-x[4], 2e7 - x[3]) - edge(x[4], x[3] - 2e5);
      return Point{x[1],
                   acceleration(x),
                   8e8 / (1e-3 + 4e-3 * (x[0] + 0.5)) * (flow_a - 4e-3 * x[1]),
                   8e8 / (1e-3 + 2.4e-3 * (0.5 - x[0])) * (flow_b + 2.4e-3 * x[1]),
                   (command(x, t) - x[4]) / kLoopValveLag_s,
                   loop.ki * error(x, t),
                   kLoopFilter_rad_per_s * (error(x, t) - x[6])};
    };
    // A rig at rest starts with its valve closed, although the load pressure is not zero.
    const Eigen::MatrixXd states = runge_kutta(
        Point{0.0, 0.0, start.outputs(0, 2), start.outputs(0, 3)}, e.times_s, 4000, rates);
    Eigen::MatrixXd other(13, 5);
    other.leftCols(4) = states.leftCols(4);
    for (Eigen::Index i = 0; i < 13; ++i) {
      Point x;
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
      other(i, 4) = command(x, e.times_s[static_cast<std::size_t>(i)]);
    }
    REQUIRE(peak(other.col(4)) > 0.3);
    REQUIRE(peak(other.col(4)) < 10.0);
    check_both_methods(e, other);
  }
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
  CHECK_FALSE(force.motion_alone());
  rig.feedback = Feedback::load_pressure;
  CHECK(layout_of(rig, values, {}, 3).states == 3);
  rig.feedback = Feedback::position;
  CHECK(layout_of(rig, values, {}, 3).states == 4);
  CHECK(layout_of(rig, values, {}, 3).motion_alone());
  values.set("pressure_feedback", 1e-8);
  CHECK_FALSE(layout_of(rig, values, {}, 3).motion_alone());
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
