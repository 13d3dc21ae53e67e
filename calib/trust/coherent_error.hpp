#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Finds the channels whose residual is not noise. Neither repeats nor `sd` specify the noise of
/// such a channel, and its residual is below the resolution of the simulations, or below that of a
/// 12-bit converter over the peak-to-peak range. Such a residual consists of model and solver
/// errors.
std::vector<std::vector<bool>> noiseless_channels(const Problem& problem,
                                                  const Evaluation& optimum);

/// Returns standard errors that include model and solver errors in channels without noise.
///
/// Such an error is the same in every repetition and need not average out over the samples. The
/// residual shows its size, but not the component that the fit has absorbed into the parameters.
/// That component is assumed to be as large as the residual and always in phase with the
/// sensitivity. By the Cauchy-Schwarz inequality a record then moves a combination c by up to |J c|
/// |r|. The channels of a condition add linearly because they come from one simulation. The errors
/// of different conditions add as independent errors, so that each condition counts as one
/// observation.
///
/// @param rows          all conditions of the fit
/// @param noiseless     for each condition and channel, whether it has no noise
/// @param combinations  combinations of the directions, one per row
/// @return              shape (combinations), 0 if all channels have noise
Eigen::VectorXd coherent_errors(const std::vector<ScoreRows>& rows,
                                const std::vector<std::vector<bool>>& noiseless,
                                const ArrowRoot& combinations);

}  // namespace rigcal::calib
