#pragma once

#include <Eigen/Core>
#include <catch2/catch.hpp>

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

}  // namespace rigcal::model
