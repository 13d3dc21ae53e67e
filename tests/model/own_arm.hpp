#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tests/model/linkage_rig.hpp"
#include "tests/model/runge_kutta.hpp"

namespace rigcal::model {

/// arm_rig() with an electric valve whose spool lags, a lever that varies, and a controller.
inline Experiment own_arm(Feedback feedback) {
  Experiment e = arm_rig().unset("pilot_gain").unset("pilot_dead_band");
  e.rig.pilot = false;
  e.rig.controller = ControllerKind::pid;
  e.rig.feedback = feedback;
  e.set("valve_gain", 2e-4).set("valve_time_constant", 0.01);
  e.set("joint_damping", 1e4).set("lever_gradient", -0.12);
  e.options.tolerance = 1e-9;
  return e;
}

// The equations of own_arm(), stated for the tests.

inline double own_lever(double angle) { return 0.3 - 0.12 * angle; }

/// Moment of the pressures [N m].
inline double own_moment(double angle, double pressure_a, double pressure_b) {
  return own_lever(angle) * (4e-3 * pressure_a - 2.4e-3 * pressure_b);
}

/// Rates of angle, angular velocity, both pressures and the spool signal, which are the first
/// elements of x.
///
/// @param load_n_m   moment against positive angle, besides viscous friction
/// @param command_v  output of the controller
template <std::size_t N>
std::array<double, 5> own_arm_rates(const std::array<double, N>& x, double load_n_m,
                                    double command_v) {
  const auto travel = [](double angle) { return 0.3 * angle - 0.06 * angle * angle; };
  const auto edge = [](double signal_v, double head_pa) {
    const double opening_m = 2e-4 * std::max(signal_v, 0.0);
    return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening_m * rounded_root(head_pa);
  };
  const double flow_a = edge(x[4], 2e7 - x[2]) - edge(-x[4], x[2] - 2e5);
  const double flow_b = edge(-x[4], 2e7 - x[3]) - edge(x[4], x[3] - 2e5);
  const double rate = own_lever(x[0]) * x[1];
  return {x[1], (own_moment(x[0], x[2], x[3]) - 1e4 * x[1] - load_n_m) / 400.0,
          8e8 / (1e-3 + 4e-3 * (travel(x[0]) - travel(-1.0))) * (flow_a - 4e-3 * rate),
          8e8 / (1e-3 + 2.4e-3 * (travel(1.0) - travel(x[0]))) * (flow_b + 2.4e-3 * rate),
          (command_v - x[4]) / 0.01};
}

/// Checks a sampled loop against one written by hand: proportional gain, integral and a limit with
/// back-calculation. It samples every 20 ms and reaches its limit.
///
/// @param e          has outputs: what is controlled, and the command; its times are set here
/// @param reference  of a time [s]
inline void check_sampled_loop(Experiment& e, const std::function<double(double)>& reference,
                               double kp, double ki, double limit) {
  constexpr double kSample_s = 0.02;
  e.set("sample_time", kSample_s).set("output_limit", limit);
  e.times_s = grid(0.0, 1.6, 161);  // every tick, and halfway between two
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  double integral = 0.0;
  bool saturated = false;
  for (Eigen::Index i = 0; i + 1 < run.outputs.rows(); i += 2) {
    const double error = reference(0.01 * static_cast<double>(i)) - run.outputs(i, 0);
    const double wanted = kp * error + integral;
    const double u = std::clamp(wanted, -limit, limit);
    integral += kSample_s * (ki * error + (u - wanted) * ki / kp);
    saturated = saturated || u != wanted;
    CAPTURE(i);
    CHECK_THAT(run.outputs(i + 1, 1), Catch::WithinAbs(u, 1e-6));
  }
  CHECK(saturated);
}

}  // namespace rigcal::model
