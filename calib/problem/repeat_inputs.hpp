#pragma once

#include <Eigen/Core>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// What the recorded inputs of the single repeats (supply pressure, tank pressure, force, a
/// recorded drive) make of the outputs: of each repeat the simulation with its own inputs minus
/// that with their mean, over the standard deviation of the mean. What an input explains is no
/// unexplained difference between repeats, and the fit, to the mean output at the mean input, has
/// accounted for it.
///
/// @return  shape (channels * samples that count, repeats); empty where no input is recorded, or
///          equal in all repeats, or a repeat cannot be simulated
Eigen::MatrixXd explained_by_inputs(const Problem& problem, std::size_t condition,
                                    std::span<const double> z);

}  // namespace rigcal::calib
