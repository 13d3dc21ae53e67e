#include "model/plant/controller.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// The parameters that a controller reads.
struct Gains {
  double kp_v_per_m = 100.0;
  double ki_v_per_m_s = 0.0;
  double kd_v_s_per_m = 0.0;
  double derivative_filter_rad_per_s = 50.0;
  double output_limit_v = 10.0;
  double sample_time_s = 0.01;
  double pressure_feedback_v_per_pa = 0.0;
  double velocity_feedforward_v_s_per_m = 0.0;
  double acceleration_feedforward_v_s2_per_m = 0.0;
  double velocity_kp_v_s_per_m = 0.0;
  double acceleration_kp_v_s2_per_m = 0.0;
  double reference_frequency_rad_per_s = 0.0;
  double reference_damping_ratio = 0.0;
};

Layout layout_with(int integral, int filter, int held) {
  Layout layout;
  layout.pid = true;
  layout.integral = integral;
  layout.filter = filter;
  layout.held = held;
  return layout;
}

/// A loop that saturates: the reference steps by twice as much as the limit allows.
Experiment step_of(double amplitude_m) {
  Experiment e;
  e.inputs.drive = Signal::square(amplitude_m, 0.1);
  e.times_s = grid(0.0, 4.9, 981);
  e.set("kp", 400.0).set("output_limit", 4.0);
  e.outputs = {Output::position, Output::command};
  return e;
}

double overshoot(const Simulation& run, double target) {
  return run.outputs.col(0).maxCoeff() / target - 1.0;
}

}  // namespace

TEST_CASE("controller: u = K_p e + I + K_d N (e - e_f), then the limit", "[model]") {
  const Gains gains{100.0, 30.0, 2.0, 50.0, 10.0, 0.01};
  const std::array<double, 2> state{0.7, 0.01};
  const Layout layout = layout_with(0, 1, -1);
  const auto small = controller_output(LoopError<double>{0.02}, state, gains, layout);
  CHECK_THAT(small.wanted, WithinRel(100.0 * 0.02 + 0.7 + 2.0 * 50.0 * (0.02 - 0.01), 1e-14));
  CHECK(small.limited == small.wanted);
  const auto large = controller_output(LoopError<double>{-0.5}, state, gains, layout);
  CHECK(large.wanted < -10.0);
  CHECK(large.limited == -10.0);
  CHECK(controller_output(LoopError<double>{0.02}, state, gains, layout_with(-1, -1, -1)).wanted ==
        2.0);
}

TEST_CASE("controller: the integral is pulled back with the integral time", "[model]") {
  const Gains gains{100.0, 50.0, 0.0, 50.0, 10.0, 0.01};
  CHECK_THAT(integral_rate(0.1, ControllerOutput<double>{14.0, 10.0}, gains),
             WithinRel(50.0 * 0.1 - 4.0 * 50.0 / 100.0, 1e-14));
  const Gains integral_only{0.0, 50.0};
  CHECK_THAT(integral_rate(0.1, ControllerOutput<double>{10.01, 10.0}, integral_only),
             WithinRel(5.0 - 0.01 * 100.0, 1e-12));
}

TEST_CASE("controller: a sampled PID does what a loop written by hand does", "[model]") {
  const Gains gains{100.0, 400.0, 1.5, 80.0, 4.0, 0.004};
  const Layout layout = layout_with(0, 1, 2);
  std::array<double, 3> state{};
  double integral = 0.0;
  double filtered = 0.0;
  bool saturated = false;
  for (int k = 0; k < 200; ++k) {
    const double error = 0.05 * std::sin(0.1 * k) + 0.01;
    controller_tick(LoopError<double>{error}, state, gains, layout);
    // Backward Euler for e_f, then u, then forward Euler for the integral with the tracking time
    // K_p / K_i.
    filtered += 0.004 * 80.0 * (error - filtered) / (1.0 + 0.004 * 80.0);
    const double wanted = 100.0 * error + integral + 1.5 * 80.0 * (error - filtered);
    const double u = std::min(4.0, std::max(-4.0, wanted));
    integral += 0.004 * (400.0 * error + (u - wanted) * 400.0 / 100.0);
    saturated = saturated || u != wanted;
    CAPTURE(k);
    CHECK_THAT(state[2], WithinAbs(u, 1e-12));
    CHECK_THAT(state[0], WithinAbs(integral, 1e-12));
    CHECK_THAT(state[1], WithinAbs(filtered, 1e-12));
  }
  CHECK(saturated);
}

TEST_CASE("controller: a slow sampled loop does not shake while it saturates", "[model]") {
  // Here K_i T_s / K_p = 5, so plain back-calculation would make the integral oscillate with
  // growing amplitude.
  const Gains gains{1.0, 50.0, 0.0, 50.0, 2.0, 0.1};
  const Layout layout = layout_with(0, -1, 1);
  std::array<double, 2> state{};
  for (int k = 0; k < 50; ++k) {
    controller_tick(LoopError<double>{1.0}, state, gains, layout);
    CHECK(state[1] <= 2.0);
    CHECK(state[0] >= 0.0);
    CHECK(state[0] <= 2.0 + 50.0 * 0.1);
  }
  CHECK(state[1] == 2.0);
}

TEST_CASE("controller: the integral is back at once after saturation", "[model]") {
  // Without anti-windup, the integral grows with the error only. The test builds that controller
  // from the same functions, with the plant reduced to an integrator of the limited command.
  const auto settle = [](bool anti_windup) {
    const Gains gains{100.0, 200.0, 0.0, 50.0, 2.0, 0.001};
    const Layout layout = layout_with(0, -1, -1);
    std::array<double, 1> integral{};
    double x = 0.0;
    double highest = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const double error = 0.1 - x;
      const auto u = controller_output(LoopError<double>{error}, integral, gains, layout);
      x += 0.001 * 0.05 * u.limited;
      integral[0] += 0.001 * (anti_windup ? integral_rate(error, u, gains) : 200.0 * error);
      highest = std::max(highest, x);
    }
    return highest / 0.1 - 1.0;
  };
  CHECK(settle(true) < 0.5 * settle(false));

  // In the whole loop, the command leaves its limit before the error changes sign.
  Experiment e = step_of(0.04);
  const Simulation p_only = e();
  e.set("ki", 800.0);
  const Simulation pi = e();
  REQUIRE(p_only.ok());
  REQUIRE(pi.ok());
  CHECK(peak(pi.outputs.col(1)) == 4.0);
  for (Eigen::Index i = 0; i < pi.outputs.rows(); ++i) {
    if (pi.outputs(i, 0) > 0.04) {
      CHECK(pi.outputs(i, 1) < 4.0);
      break;
    }
  }
  CHECK(overshoot(pi, 0.04) < 0.35);
  CHECK_THAT(pi.outputs(980, 0), WithinAbs(0.04, 0.04 * 0.01));
}

TEST_CASE("controller: the filtered derivative is the transfer function's", "[model]") {
  // The plant cannot move (mass 1e6 kg, valve almost closed), so e equals the reference, and the
  // command is K_p e + K_d N s / (s + N) e. It has a closed form for a sine that starts at t = 0.
  Experiment e;
  const double n = 40.0;
  const double omega = 2.0 * 3.14159265358979323846 * 2.0;
  e.inputs.drive = Signal::sine(0.01, 2.0);
  e.set("mass", 1e6).set("valve_gain", 1e-12).set("kd", 5.0).set("derivative_filter", n);
  e.outputs = {Output::command};
  e.options.tolerance = 1e-8;
  const Simulation run = e();
  REQUIRE(run.ok());
  for (std::size_t i = 0; i < e.times_s.size(); ++i) {
    const double t = e.times_s[i];
    const double sine = 0.01 * std::sin(omega * t);
    // e_f' = N (e - e_f), e_f(0) = 0
    const double filtered =
        0.01 * n / (n * n + omega * omega) *
        (n * std::sin(omega * t) - omega * std::cos(omega * t) + omega * std::exp(-n * t));
    const double expected = 78.74 * sine + 5.0 * n * (sine - filtered);
    CAPTURE(t);
    // Ten times the tolerance, relative to the peak of u of 1.3 V. This includes the dense output.
    CHECK_THAT(run.outputs(static_cast<Eigen::Index>(i), 0), WithinAbs(expected, 1e-6));
  }
}

TEST_CASE("controller: a PID of the whole loop against a Runge-Kutta of small steps", "[model]") {
  // An independent implementation with fixed steps of 2 us (the hydraulic mode has 587 rad/s).
  Experiment e;
  e.inputs.drive = Signal::sine(0.02, 1.0);
  e.set("kp", 300.0).set("ki", 500.0).set("kd", 2.0).set("derivative_filter", 100.0);
  e.set("output_limit", 3.0);
  e.times_s = grid(0.0, 0.5, 26);
  e.outputs = {Output::position, Output::command};
  e.options.tolerance = 1e-8;
  const Simulation run = e();
  REQUIRE(run.ok());

  using Vector = Eigen::Matrix<double, 5, 1>;  // x, v, P_L, I, e_f
  const auto command = [](const Vector& s, double error) {
    const double wanted = 300.0 * error + s(3) + 2.0 * 100.0 * (error - s(4));
    return std::make_pair(wanted, std::min(3.0, std::max(-3.0, wanted)));
  };
  const auto error_at = [](const Vector& s, double t) {
    return 0.02 * std::sin(2.0 * 3.14159265358979323846 * t) - s(0);
  };
  const auto root = [](double p) { return p / std::pow(p * p + 1e4, 0.25); };
  const auto f = [&](const Vector& s, double t) {
    const double error = error_at(s, t);
    const auto [wanted, u] = command(s, error);
    const double head = 6.2e6 - (u < 0.0 ? -1.0 : 1.0) * s(2);
    const double flow = 0.6 * 0.02075 * 0.0406e-3 * u * root(head) / std::sqrt(847.0);
    const double leak = 0.35 * 4.456e-6 * std::sqrt(2.0 / 847.0) * root(s(2));
    Vector d;
    d << s(1), (1.62e-3 * s(2) - 1000.0 * s(1)) / 85.0,
        4.0 * 689e6 / 2.46888e-4 * (flow - leak - 1.62e-3 * s(1)),
        500.0 * error + (u - wanted) * 500.0 / 300.0, 100.0 * (error - s(4));
    return d;
  };
  const double h = 2e-6;
  Vector s = Vector::Zero();
  double worst_x = 0.0;
  double worst_u = 0.0;
  for (int i = 0; i <= 25; ++i) {
    const double t0 = 0.02 * i;
    worst_x = std::max(worst_x, std::abs(s(0) - run.outputs(i, 0)));
    worst_u = std::max(worst_u, std::abs(command(s, error_at(s, t0)).second - run.outputs(i, 1)));
    for (int k = 0; k < 10000; ++k) {
      const double t = t0 + k * h;
      const Vector k1 = f(s, t);
      const Vector k2 = f(s + 0.5 * h * k1, t + 0.5 * h);
      const Vector k3 = f(s + 0.5 * h * k2, t + 0.5 * h);
      const Vector k4 = f(s + h * k3, t + h);
      s += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
  CHECK(peak(run.outputs.col(1)) == 3.0);
  // Kinks at the limit cost some digits of the requested 1e-8, which leaves 1e-5 of the peaks.
  CHECK(worst_x < 1e-5 * 0.02);
  CHECK(worst_u < 1e-5 * 3.0);
}

TEST_CASE("controller: one tick pulls the integral back to the limit at the most", "[model]") {
  // With K_i T_s / K_p = 1.5, plain back-calculation would overshoot the limit by half of the
  // excess.
  const Gains gains{1.0, 15.0, 0.0, 50.0, 2.0, 0.1};
  std::array<double, 2> state{6.0, 0.0};
  controller_tick(LoopError<double>{0.0}, state, gains, layout_with(0, -1, 1));
  CHECK(state[1] == 2.0);
  CHECK_THAT(state[0], WithinRel(2.0, 1e-14));
}

TEST_CASE("controller: a sampled output is that of the last tick", "[model]") {
  // The plant cannot move, so the error equals the reference, a ramp of 0.1 m/s.
  Experiment e;
  e.inputs.drive = Signal::linear({0.0, 1.0}, {0.0, 0.1});
  e.set("mass", 1e6).set("valve_gain", 1e-12).set("kp", 50.0).set("sample_time", 0.02);
  e.times_s = grid(0.005, 0.195, 20);
  e.times_s.insert(e.times_s.begin(), 0.0);
  e.outputs = {Output::command};
  const Simulation run = e();
  REQUIRE(run.ok());
  for (std::size_t i = 0; i < e.times_s.size(); ++i) {
    const double tick_s = 0.02 * std::floor(e.times_s[i] / 0.02);
    CHECK_THAT(run.outputs(static_cast<Eigen::Index>(i), 0), WithinAbs(50.0 * 0.1 * tick_s, 1e-8));
  }
}
