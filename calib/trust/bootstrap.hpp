#pragma once

#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Length of the blocks in which residuals are drawn: (2 G^2 / D)^(1/3) n^(1/3) with G = sum |h|
/// gamma_h, D = 4/3 (sum gamma_h)^2 of their noise model (Politis and White, Econometric Reviews
/// 23, 2004, circular blocks), from 1 to n.
std::size_t block_length(const metrics::Autoregression& noise, std::size_t samples);

/// Bootstrap of a fit: every replicate is drawn anew and fitted from the optimum with the same
/// weights.
///
/// A condition whose record has its repeats (`Series::deviations`, at least 3) draws as many of
/// them with replacement: record + mean of the drawn deviations. This assumes nothing about the
/// noise within a repeat, and keeps the model error. R repeats show only sqrt((R - 1) / R) of their
/// standard deviation, which is corrected.
///
/// Any other condition is simulation + residuals drawn in circular blocks, all channels together.
/// The residuals are enlarged by the part that the fit has removed from their variance. Model
/// errors count as noise here.
///
/// Intervals are percentiles; their distance from the estimate is widened by the quantile of
/// Student's t over that of the normal distribution. Degrees of freedom are Satterthwaite's over
/// the conditions, R - 1 for each with repeats. Enters the result into `fit.parameters`, and how it
/// was made, or why not, into `fit.bootstrap_message`. Random numbers depend only on seed,
/// replicate and condition.
///
/// @param found   with scatter
/// @param scores  of the problem's conditions at the optimum, in their order
/// @param left  budget of the whole job; a limit of evaluations ends the bootstrap after the same
///              replicate for any number of threads
void bootstrap(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
               const std::vector<ConditionScore>& scores, const FitOptions& options, Fit& fit,
               Budget& left);

}  // namespace rigcal::calib
