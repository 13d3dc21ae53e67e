#include "model/solver/error_norm.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/rig.hpp"

using namespace rigcal::model;
using Catch::WithinRel;

namespace {

constexpr double kTolerance = 1e-4;
using Norm = ErrorNorm<2, 1>;
using X = Norm::X;

X state(double x, double x_p, double y, double y_p) {
  X s{Active<1>(x), Active<1>(y)};
  s[0].derivative.set(0, x_p);
  s[1].derivative.set(0, y_p);
  return s;
}
const X kZero = state(0.0, 0.0, 0.0, 0.0);
Norm norm(int states = 2) { return {states, {1e-6, 100.0}, {2.0}, kTolerance, 50.0}; }

double worst(const Norm& n, const X& error, const X& x_new) {
  return std::max(n.of_states(error, x_new), n.of_sensitivities(error, x_new));
}

}  // namespace

TEST_CASE("error_norm: each state against its own running peak", "[model]") {
  Norm n = norm();
  n.see(state(0.5, 0.0, 2e6, 0.0));
  n.see(state(0.1, 0.0, 1e6, 0.0));
  const X now = state(0.1, 0.0, 1e6, 0.0);
  const double e = worst(n, state(0.5 * kTolerance, 0.0, 0.0, 0.0), now);
  CHECK_THAT(e, WithinRel(std::sqrt(0.5), 1e-14));  // one of two states is at its tolerance
  CHECK_THAT(worst(n, state(0.0, 0.0, 2e6 * kTolerance, 0.0), now),
             WithinRel(std::sqrt(0.5), 1e-14));
  // A new value above the peak counts immediately.
  CHECK_THAT(worst(n, state(kTolerance, 0.0, 0.0, 0.0), state(1.0, 0.0, 0.0, 0.0)),
             WithinRel(std::sqrt(0.5), 1e-14));
}

TEST_CASE("error_norm: a state at rest counts from its floor", "[model]") {
  CHECK_THAT(worst(norm(), state(1e-6 * kTolerance, 0.0, 0.0, 0.0), kZero),
             WithinRel(std::sqrt(0.5), 1e-14));
}

TEST_CASE("error_norm: a state that the rig does not have counts for nothing", "[model]") {
  Norm n = norm(1);
  n.see(state(1.0, 3.0, 0.0, 0.0));
  CHECK_THAT(n.of_states(state(kTolerance, 0.0, 0.0, 0.0), kZero), WithinRel(1.0, 1e-14));
  CHECK_THAT(n.of_sensitivities(state(0.0, 150.0 * kTolerance, 0.0, 0.0), kZero),
             WithinRel(1.0, 1e-14));
}

TEST_CASE("error_norm: the worst of state and sensitivities rules", "[model]") {
  Norm n = norm();
  n.see(state(1.0, 3.0, 1e6, 0.0));
  const double state_error = 0.1 * kTolerance;
  const double e = worst(n, state(state_error, 3.0 * kTolerance * 50.0, 0.0, 0.0), kZero);
  CHECK_THAT(e, WithinRel(std::sqrt(0.5), 1e-14));  // the tolerance is fifty times looser
  // The floor of a sensitivity that is still zero is one hundredth of state / parameter.
  Norm fresh = norm();
  fresh.see(state(1.0, 0.0, 1e6, 0.0));
  CHECK_THAT(worst(fresh, state(0.0, 50.0 * kTolerance * 0.01 * 1.0 / 2.0, 0.0, 0.0), kZero),
             WithinRel(std::sqrt(0.5), 1e-14));
}

TEST_CASE("error_norm: what is not a number is not accepted", "[model]") {
  for (const double bad : {kNaN, kInfinity}) {
    CHECK_FALSE(std::isfinite(norm().of_states(state(bad, 0.0, 0.0, 0.0), kZero)));
    CHECK_FALSE(std::isfinite(norm().of_sensitivities(state(0.0, 0.0, 0.0, bad), kZero)));
  }
}
