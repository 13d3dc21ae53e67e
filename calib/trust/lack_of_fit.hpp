#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/model_error.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Compares the residual of every channel of known noise with its pure error: F = variance of the
/// residual / variance of the mean of the repeats. Both come from records that are correlated in
/// time. A sum of n squares therefore counts n / (1 + 2 sum rho_h^2) degrees of freedom, with the
/// autocorrelation rho_h of the residual (Bartlett; it is that of the noise, too, if the model is
/// right). For the pure error this is multiplied by repeats - 1; it is infinite if the campaign
/// states `sd`. The variance of the residual is that of its noise model, corrected for the part
/// that the fit has removed.
///
/// A test has passed if a residual of twice the noise would have failed it.
///
/// @param found  with scatter; without it there is no test
std::vector<LackOfFit> lack_of_fit(const Problem& problem, const Uncertainty& found);

/// The same test for a prediction, from which no parameter was estimated: mean square of the
/// residual divided by the variance of the mean of the repeats.
///
/// @param residual  shape (samples in windows), measured - simulated, SI
/// @return  not judged yet; empty if the noise of the channel is unknown, or the residual is zero
std::optional<LackOfFit> lack_of_prediction(const ProblemCondition& condition,
                                            const ProblemChannel& channel,
                                            std::span<const double> residual);

/// Sets the outcome of tests that are made together: each at 5 % over their number (Bonferroni).
void judge_together(std::vector<LackOfFit>& tests);

/// Whether there is a significant lack of fit, at 5 % for all tests together (Bonferroni): of one
/// channel. Not where all have passed; empty where none has failed and one cannot be judged, or
/// without a test.
std::optional<bool> misfit(const std::vector<LackOfFit>& tests);

/// The test of the least p; null without one.
const LackOfFit* least_likely(const std::vector<LackOfFit>& tests);

}  // namespace rigcal::calib
