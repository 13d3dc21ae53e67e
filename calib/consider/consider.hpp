#pragma once

#include <atomic>
#include <optional>
#include <span>

#include "calib/problem/problem.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Widens the intervals of a fit to account for the small effects that the model omits (consider
/// covariance: S. F. Schmidt, Advances in Control Systems 3, 1966). In contrast to that method, the
/// records also update the sizes of the effects.
///
/// At its plausible size, each effect e_k adds E_k to the residual r, measured minus simulated. The
/// fit has mistaken the component B B^T E e for a change in the estimates, which in coordinates of
/// the root is C e with C = B^T E. The remaining component appears in the residuals. Let it have
/// the information matrix M = E^T (I - B B^T) E and the score s, and let V be the covariance of
/// that score, computed from the residuals or from the repeats. With the prior N(0, 1) for e, the
/// posterior precision of e is 1 + M V^-1 M, and its mean is (1 + M V^-1 M)^-1 M V^-1 s. Effects
/// that cannot be negative are truncated at zero. The uncertainty of an estimate combines the error
/// that it would have if the model were exact with the remaining uncertainty of C e. Its interval
/// covers the estimate as well as the estimates corrected for the mean and for the likeliest sizes
/// of the effects, each plus or minus the expanded uncertainty. It always includes the interval for
/// an exact model.
///
/// The function also names the effects that the residuals indicate. For this it uses a score test
/// of each effect with the same V, Holm's correction, and forward selection.
///
/// @param found  uncertainty at the optimum, including the scores of the residuals
/// @param fit         must already contain the parameters of the problem's unknowns
/// @param likelihood  if not null, receives the likelihood of the sizes; unchanged if no
///                    effect was considered
void consider_effects(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                      int threads, const std::atomic<bool>* cancel, Fit& fit,
                      std::optional<EffectLikelihood>* likelihood = nullptr);

}  // namespace rigcal::calib
