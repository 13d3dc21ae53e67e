#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/model_error.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Compares the residual of every channel whose noise is known with the pure error of that channel:
/// F = variance of the residual / variance of the mean of the repeats. Both come from records that
/// are correlated in time. A sum of n squares therefore has only n / (1 + 2 sum rho_h^2) degrees of
/// freedom, where rho_h is the autocorrelation of the residual (Bartlett; if the model is right,
/// the noise has the same autocorrelation). For the pure error this number is multiplied by repeats
/// - 1, or is infinite if the campaign states `sd`. The variance of the residual is taken from its
/// noise model, corrected for the variance that the fit removed.
///
/// A test passes only if it would have failed for a residual of twice the noise.
///
/// @param found  must include `scatter`; without it there is no test
std::vector<LackOfFit> lack_of_fit(const Problem& problem, const Uncertainty& found);

/// Tests a prediction for lack of fit. No parameter was estimated from its record, so the ratio is
/// the mean square of the residual divided by the variance of the mean of the repeats.
///
/// @param residual  shape (samples in windows), measured - simulated, SI
/// @return          a test without an outcome; std::nullopt if the noise of the channel is unknown
///                  or the residual is zero
std::optional<LackOfFit> lack_of_prediction(const ProblemCondition& condition,
                                            const ProblemChannel& channel,
                                            std::span<const double> residual);

/// Returns the smallest model error that a test would reject at a significance level, as a multiple
/// of the noise. An error of this size is found in about half of cases.
double detectable_error(const LackOfFit& test, double level);

/// Sets the outcomes of tests that are made together, each at 5 % divided by their number
/// (Bonferroni).
void judge_together(std::vector<LackOfFit>& tests);

/// Returns true if at least one channel shows a significant lack of fit, at 5 % for all tests
/// together (Bonferroni). Returns false if all tests passed, and std::nullopt if there are no
/// tests, or none failed but at least one could not be judged.
std::optional<bool> misfit(const std::vector<LackOfFit>& tests);

/// Returns the test with the smallest p, or null if there are no tests.
const LackOfFit* least_likely(const std::vector<LackOfFit>& tests);

}  // namespace rigcal::calib
