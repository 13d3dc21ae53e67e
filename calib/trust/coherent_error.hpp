#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Finds the channels whose residual is no noise: neither repeats nor `sd` give their noise, and
/// the residual is below the resolution of the simulations, or of a converter of 12 bits over the
/// peak-to-peak. Such a residual consists of errors of the model and of its solver.
std::vector<std::vector<bool>> noiseless_channels(const Problem& problem,
                                                  const Evaluation& optimum);

/// Standard errors that include errors of model and solver in channels without noise.
///
/// Such an error is equal in every repetition, and need not average out over the samples. The
/// residual shows its size, but not the part that the fit has absorbed in the parameters. That part
/// is assumed to be as large as the residual and in phase with the sensitivity throughout. By the
/// inequality of Cauchy and Schwarz a record then moves a combination c by up to |J c| |r|. The
/// channels of a condition add linearly, since they come from one simulation; conditions add as
/// independent errors. Each condition thus counts as one observation.
///
/// @param rows          all conditions of the fit
/// @param noiseless     per condition and channel
/// @param combinations  of the directions, one per row
/// @return              shape (combinations), 0 if all channels have noise
Eigen::VectorXd coherent_errors(const std::vector<ScoreRows>& rows,
                                const std::vector<std::vector<bool>>& noiseless,
                                const ArrowRoot& combinations);

}  // namespace rigcal::calib
