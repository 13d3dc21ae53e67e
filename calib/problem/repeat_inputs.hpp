#pragma once

#include <Eigen/Core>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Effect of the recorded inputs of single repeats (supply pressure, tank pressure, force, a
/// recorded drive) on the outputs. For each repeat it is the simulation with its own inputs minus
/// that with their mean, divided by the standard deviation of the mean. A difference that an input
/// explains is no unexplained difference between repeats, and the fit of the mean output at the
/// mean input has accounted for it.
///
/// @return  shape (channels * samples in windows, repeats); empty if no input is recorded, or all
///          are equal, or a repeat cannot be simulated
Eigen::MatrixXd explained_by_inputs(const Problem& problem, std::size_t condition,
                                    std::span<const double> z);

}  // namespace rigcal::calib
