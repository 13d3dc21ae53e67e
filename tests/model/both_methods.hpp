#pragma once

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <span>

#include "tests/model/rig.hpp"

namespace rigcal::model {

/// Checks that both methods of the solver agree with a run of another integrator. At the tolerance
/// 1e-9 they are some hundred times closer.
///
/// @param other  shape (times, outputs)
inline void check_both_methods(Experiment e, const Eigen::MatrixXd& other) {
  e.options.tolerance = 1e-9;
  for (const Method method : {Method::rosenbrock, Method::dopri5}) {
    e.options.method = method;
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    CAPTURE(difference(run.outputs, other));
    CHECK(difference(run.outputs, other) < 2e-5);
  }
}

/// Returns the first three states of another integrator, and the command to the valve as a fourth
/// column.
///
/// @param states   shape (times, states)
/// @param command  called with a state and its time
template <typename Point, typename Command>
Eigen::MatrixXd with_command(const Eigen::MatrixXd& states, std::span<const double> times_s,
                             Command command) {
  Eigen::MatrixXd result(states.rows(), 4);
  result.leftCols(3) = states.leftCols(3);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    Point x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
    result(i, 3) = command(x, times_s[static_cast<std::size_t>(i)]);
  }
  return result;
}

}  // namespace rigcal::model
