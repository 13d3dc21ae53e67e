#pragma once

#include <atomic>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Widens the intervals of a fit by the small effects that the model omits (consider covariance: S.
/// F. Schmidt, Advances in Control Systems 3, 1966). Here the records also update the effects
/// themselves.
///
/// At its plausible size, each effect e_k adds E_k to the residual r, measured minus simulated. The
/// fit has mistaken B B^T E e for a change of the estimates. In coordinates of the root, this
/// change is C e with C = B^T E. The residuals show the rest. Let e have the prior N(0, 1), the
/// rest the matrix M = E^T (I - B B^T) E and the score s, and that score the covariance V, computed
/// from the residuals or from the repeats. Then e has the precision 1 + M V^-1 M and the mean
/// (1 + M V^-1 M)^-1 M V^-1 s. Effects that cannot be negative are truncated at zero. The
/// uncertainty of an estimate combines its error if the model were exact with the remaining
/// uncertainty of C e. Its interval covers the estimate, and also the estimates corrected for the
/// mean and for the likeliest sizes of the effects, each plus or minus the expanded uncertainty. It
/// always includes the interval of the exact model.
///
/// The function also names the effects that the residuals indicate. It uses score tests of each
/// effect with the same V, Holm's correction, and forward selection.
///
/// @param found  uncertainty at the optimum, with the scores of its residuals
/// @param fit    its parameters are the problem's unknowns, already described
void consider_effects(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                      int threads, const std::atomic<bool>* cancel, Fit& fit);

}  // namespace rigcal::calib
