#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Which channels of the conditions leave a residual that is no noise: neither repeats nor `sd`
/// tell any, and the residual is smaller than the simulations resolve, or than a converter of 12
/// bits does over the peak-to-peak. What is left there are errors of the model and of its solver.
std::vector<std::vector<bool>> noiseless_channels(const Problem& problem,
                                                  const Evaluation& optimum);

/// Standard errors that allow for errors of model and solver in channels that hold no noise. Such
/// an error is as large in every repetition, and need not average out over the samples. The
/// residual tells how large it is, not which part of it the fit has taken for a change of the
/// parameters: that part is assumed as large as the residual and in phase with the sensitivity
/// throughout. By the inequality of Cauchy and Schwarz a record then moves a combination c by up to
/// |J c| |r|; the channels of a condition add up, since they come from one simulation, and
/// conditions as independent errors do. Each condition thus counts as one observation.
///
/// @param rows          all conditions of the fit
/// @param noiseless     per condition and channel
/// @param combinations  of the directions, one per unknown
/// @return              shape (unknowns), 0 where all channels hold noise
Eigen::VectorXd coherent_errors(const std::vector<ScoreRows>& rows,
                                const std::vector<std::vector<bool>>& noiseless,
                                const ArrowRoot& combinations);

}  // namespace rigcal::calib
