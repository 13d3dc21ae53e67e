#include "model/solver/rosenbrock.hpp"

#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "model/solver/dormand_prince.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;

namespace {

/// One equation x' = f(x, t; p), with the derivatives that a step needs, written by hand.
struct Equation {
  std::function<double(double x, double t)> f;
  std::function<double(double x, double t)> f_x;
  std::function<double(double x, double t)> f_t;
  std::function<double(double t)> exact;
  double start_s = 0.0;

  State<1, 0> derivative(const State<1, 0>& x, double t) const { return {f(x[0], t)}; }
  Values<1> derivative_of_values(const Values<1>& x, double t) const { return {f(x[0], t)}; }
  Linearisation<1, 0> linearise(double x, double t) const {
    Linearisation<1, 0> lin;
    lin.f[0] = f(x, t);
    lin.f_t[0] = f_t(x, t);
    lin.jacobian[0][0] = f_x(x, t);
    return lin;
  }
};

/// x' = -t x^2, x(0) = 2: nonlinear and dependent on time; x = 2 / (1 + t^2).
Equation nonlinear() {
  return {[](double x, double t) { return -t * x * x; },
          [](double x, double t) { return -2.0 * t * x; }, [](double x, double) { return -x * x; },
          [](double t) { return 2.0 / (1.0 + t * t); }};
}

/// Prothero and Robinson's problem: x' = -lambda (x - g) + g' with g = sin(t + 1), whose solution
/// is g.
Equation prothero_robinson(double lambda) {
  return {[=](double x, double t) { return -lambda * (x - std::sin(t + 1.0)) + std::cos(t + 1.0); },
          [=](double, double) { return -lambda; },
          [=](double, double t) { return lambda * std::cos(t + 1.0) - std::sin(t + 1.0); },
          [](double t) { return std::sin(t + 1.0); }};
}

struct Errors {
  double end = 0.0;    ///< at t = 1
  double dense = 0.0;  ///< largest error within the steps
};

Errors errors_of(const Equation& equation, int steps) {
  Rosenbrock<1, 0> stepper;
  State<1, 0> x{equation.exact(0.0)};
  Errors errors;
  const double dt = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    State<1, 0> x_new;
    State<1, 0> error;
    stepper.do_step(equation, equation.linearise(x[0], t), x, t, x_new, dt, error);
    const auto between = stepper.dense_output(x, x_new);
    for (const double s : {0.25, 0.5, 0.75})
      errors.dense = std::max(errors.dense, std::abs(between(0, s) - equation.exact(t + s * dt)));
    x = x_new;
  }
  errors.end = std::abs(x[0] - equation.exact(1.0));
  return errors;
}

namespace odeint = boost::numeric::odeint;
using AsShipped = odeint::default_rosenbrock_coefficients<double>;
struct SignOfD4Changed : AsShipped {
  const double d4 = -AsShipped::d4;
};

/// A step of Odeint's rosenbrock4 for one equation, with its coefficients. The original uses uBLAS,
/// which does not compile as C++20 in Boost 1.74.
template <typename Coefficients>
double odeint_error(const Equation& equation, int steps) {
  const Coefficients c;
  double x = equation.exact(0.0);
  const double dt = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    const double f_t = equation.f_t(x, t) * dt;
    const double w = 1.0 / (c.gamma * dt) - equation.f_x(x, t);
    const auto f = [&](double y, double s) { return equation.f(y, t + s * dt); };
    const double g1 = (f(x, 0.0) + c.d1 * f_t) / w;
    const double g2 = (f(x + c.a21 * g1, c.c2) + c.d2 * f_t + c.c21 * g1 / dt) / w;
    const double g3 =
        (f(x + c.a31 * g1 + c.a32 * g2, c.c3) + c.d3 * f_t + (c.c31 * g1 + c.c32 * g2) / dt) / w;
    const double g4 = (f(x + c.a41 * g1 + c.a42 * g2 + c.a43 * g3, c.c4) + c.d4 * f_t +
                       (c.c41 * g1 + c.c42 * g2 + c.c43 * g3) / dt) /
                      w;
    x += c.a51 * g1 + c.a52 * g2 + c.a53 * g3 + c.a54 * g4;
    const double g5 = (f(x, 1.0) + (c.c51 * g1 + c.c52 * g2 + c.c53 * g3 + c.c54 * g4) / dt) / w;
    x += g5;
    x += (f(x, 1.0) + (c.c61 * g1 + c.c62 * g2 + c.c63 * g3 + c.c64 * g4 + c.c65 * g5) / dt) / w;
  }
  return std::abs(x - equation.exact(1.0));
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("rosenbrock: order 4 where the equation is nonlinear and depends on time", "[model]") {
  const Errors coarse = errors_of(nonlinear(), 40);
  const Errors fine = errors_of(nonlinear(), 80);
  CHECK(order(coarse.end, fine.end) > 3.8);
  CHECK(order(coarse.dense, fine.dense) > 3.0);
  CHECK(fine.end < 1e-7);
}

TEST_CASE("rosenbrock: no order reduction on Prothero and Robinson's problem", "[model]") {
  // Order 4 with the same constant for every stiffness: the worst error over all lambda has this
  // order. (For a given large lambda, the error is h^3 / lambda, which is far smaller.)
  const auto worst_error = [](int steps) {
    Errors worst;
    for (const double lambda : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
      const Errors errors = errors_of(prothero_robinson(lambda), steps);
      worst.end = std::max(worst.end, errors.end);
      worst.dense = std::max(worst.dense, errors.dense);
    }
    return worst;
  };
  const Errors coarse = worst_error(16);
  const Errors fine = worst_error(32);
  CHECK(order(coarse.end, fine.end) > 3.8);
  CHECK(order(coarse.dense, fine.dense) > 3.8);
  CHECK(fine.end < 1e-8);
  CHECK(errors_of(prothero_robinson(1e6), 32).end < 1e-12);
}

TEST_CASE("rosenbrock4 of Odeint: loses order where the equation depends on time", "[model]") {
  // This is why it is not used: d4 in default_rosenbrock_coefficients has the wrong sign.
  const auto measured_order = [](auto error) { return order(error(40), error(80)); };
  const auto shipped = [](int n) { return odeint_error<AsShipped>(nonlinear(), n); };
  const auto changed = [](int n) { return odeint_error<SignOfD4Changed>(nonlinear(), n); };
  CHECK(measured_order(shipped) < 3.2);
  CHECK(measured_order(changed) > 3.7);
  CHECK(shipped(80) > 100.0 * errors_of(nonlinear(), 80).end);
}

TEST_CASE("rosenbrock: L-stable, an infinitely fast mode is gone after one step", "[model]") {
  for (const double z : {1e2, 1e4, 1e8}) {
    const Equation decay{[=](double x, double) { return -z * x; },
                         [=](double, double) { return -z; }, [](double, double) { return 0.0; },
                         [](double) { return 1.0; }};
    Rosenbrock<1, 0> stepper;
    const State<1, 0> x{1.0};
    State<1, 0> x_new;
    State<1, 0> error;
    stepper.do_step(decay, decay.linearise(1.0, 0.0), x, 0.0, x_new, 1.0, error);
    CAPTURE(z, x_new[0]);
    CHECK(std::abs(x_new[0]) < 20.0 / z);  // R(z) falls at least as fast as 1 / z
  }
}

namespace {

/// Two states, two parameters: x' = y + sin(p t), y' = -q x y - 3 x, differentiated by hand.
struct Pair {
  double p = 1.3;
  double q = 0.8;
  using X = State<2, 2>;
  using D = Dual<2>;

  static D dual(double value, double by_p, double by_q) {
    D d(value);
    d.derivative.set(0, by_p);
    d.derivative.set(1, by_q);
    return d;
  }

  X derivative(const X& s, double t) const {
    const D drive = dual(std::sin(p * t), t * std::cos(p * t), 0.0);
    return {s[1] + drive, -(dual(q, 0.0, 1.0) * s[0] * s[1]) - s[0] * 3.0};
  }
  Values<2> derivative_of_values(const Values<2>& s, double t) const {
    return {s[1] + std::sin(p * t), -q * s[0] * s[1] - 3.0 * s[0]};
  }
  Linearisation<2, 2> linearise(const Values<2>& s, double t) const {
    Linearisation<2, 2> lin;
    lin.f = derivative_of_values(s, t);
    lin.f_t = {p * std::cos(p * t), 0.0};
    lin.jacobian = {Values<2>{0.0, 1.0}, Values<2>{-q * s[1] - 3.0, -q * s[0]}};
    lin.f_p = {dual(0.0, t * std::cos(p * t), 0.0).derivative,
               dual(0.0, 0.0, -s[0] * s[1]).derivative};
    return lin;
  }
};

/// Integrates from t = 0 to 1.
Pair::X after_a_second(const Pair& system, int steps) {
  Rosenbrock<2, 2> stepper;
  Pair::X x{Pair::D(0.9), Pair::D(-0.4)};
  const double dt = 1.0 / steps;
  Linearisation<2, 2> lin = system.linearise(values_of(x), 0.0);
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    Pair::X x_new;
    Pair::X error;
    stepper.do_step(system, lin, x, t, x_new, dt, error);
    lin = stepper.sensitivities(system, lin, x, t, x_new, dt, error);
    x = x_new;
  }
  return x;
}

}  // namespace

TEST_CASE("rosenbrock: sensitivities are the derivatives of the solution", "[model]") {
  constexpr double kStep = 1e-4;
  constexpr int kSteps = 256;
  const Pair nominal;
  const Pair::X end = after_a_second(nominal, kSteps);
  const auto difference = [](const Pair& right, const Pair& left, std::size_t i) {
    return (after_a_second(right, kSteps)[i].value - after_a_second(left, kSteps)[i].value) /
           (2.0 * kStep);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(i);
    // Error of the central difference: kStep^2 times a third derivative of about 1.
    CHECK_THAT(end[i].derivative[0],
               WithinAbs(difference({1.3 + kStep, 0.8}, {1.3 - kStep, 0.8}, i), 2e-8));
    CHECK_THAT(end[i].derivative[1],
               WithinAbs(difference({1.3, 0.8 + kStep}, {1.3, 0.8 - kStep}, i), 2e-8));
    CHECK(std::abs(end[i].derivative[0]) > 1e-2);
    CHECK(std::abs(end[i].derivative[1]) > 1e-2);
  }
}

TEST_CASE("rosenbrock: order of the sensitivities", "[model]") {
  const Pair nominal;
  const Pair::X exact = after_a_second(nominal, 1024);
  const auto error = [&](int steps) {
    const Pair::X x = after_a_second(nominal, steps);
    double worst = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j)
        worst = std::max(worst, std::abs(x[i].derivative[j] - exact[i].derivative[j]));
    }
    return worst;
  };
  const double order = std::log2(error(16) / error(32));
  CAPTURE(error(16), error(32), order);
  CHECK(order > 2.8);
}

TEST_CASE("dormand_prince: order 5, and 4 between the steps", "[model]") {
  const auto errors = [](int steps) {
    const Equation equation = nonlinear();
    DormandPrince<1, 0> stepper;
    State<1, 0> x{equation.exact(0.0)};
    Errors result;
    const double dt = 1.0 / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = i * dt;
      State<1, 0> x_new;
      State<1, 0> error;
      stepper.do_step(equation, equation.derivative(x, t), x, t, x_new, dt, error);
      const auto between = stepper.dense_output(x, x_new, dt);
      for (const double s : {0.2, 0.5, 0.8})
        result.dense = std::max(result.dense, std::abs(between(0, s) - equation.exact(t + s * dt)));
      x = x_new;
    }
    result.end = std::abs(x[0] - equation.exact(1.0));
    return result;
  };
  const Errors coarse = errors(10);
  const Errors fine = errors(20);
  CHECK(order(coarse.end, fine.end) > 4.7);
  CHECK(order(coarse.dense, fine.dense) > 4.0);
}
