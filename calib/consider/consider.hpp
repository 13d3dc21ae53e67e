#pragma once

#include <atomic>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Widens the intervals of a fit by the small effects that the model leaves out (consider
/// covariance: S. F. Schmidt, Advances in Control Systems 3, 1966, with the effects themselves
/// updated by the records).
///
/// Each effect e_k at its plausible size adds E_k to the residual r, measured minus simulated. The
/// fit has mistaken B B^T E e for a change of the estimates, which is C e in coordinates of the
/// root, C = B^T E; the residuals show the rest. With the prior e ~ N(0, 1) and the rest
/// M = E^T (I - B B^T) E, its score s, and the covariance V of that score by the scatter of the
/// residuals or of the repeats, e has the precision 1 + M V^-1 M and the mean (1 + M V^-1 M)^-1
/// M V^-1 s. Effects that cannot be negative are cut off at zero. An estimate then is uncertain by
/// its error if the model were exact, and by what C e leaves open; its interval
/// covers the estimate, and the estimates that the mean and the likeliest sizes of the effects
/// would give, each with the expanded uncertainty. It always includes that of the exact model.
///
/// It also names the effects that the residuals ask for, by score tests of each alone, by the same
/// V, Holm's correction, and forward selection.
///
/// @param found  uncertainty at the optimum, with the scores of its residuals
/// @param fit    its parameters are those of the problem's unknowns, described
void consider_effects(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                      int threads, const std::atomic<bool>* cancel, Fit& fit);

}  // namespace rigcal::calib
