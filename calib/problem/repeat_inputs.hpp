#pragma once

#include <Eigen/Core>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Returns how the recorded inputs of individual repeats (supply pressure, tank pressure, force, a
/// recorded drive) affect the outputs. For each repeat this is the simulation with its own inputs
/// minus the simulation with the mean inputs, divided by the standard deviation of the mean. A
/// difference that an input explains does not count as an unexplained difference between repeats,
/// and a fit of the mean output to the mean input already accounts for it.
///
/// @return  shape (channels * samples in windows, repeats); empty if no input was recorded, all
///          repeats have equal inputs, or a repeat cannot be simulated
Eigen::MatrixXd explained_by_inputs(const Problem& problem, std::size_t condition,
                                    std::span<const double> z);

}  // namespace rigcal::calib
