#pragma once

#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Returns the length of the blocks in which residuals are drawn, from 1 to n. It is (2 G^2 /
/// D)^(1/3) n^(1/3), where G = sum |h| gamma_h and D = 4/3 (sum gamma_h)^2 follow from the noise
/// model of the residuals (Politis and White, Econometric Reviews 23, 2004, circular blocks).
std::size_t block_length(const metrics::Autoregression& noise, std::size_t samples);

/// Bootstraps a fit: draws replicates of the records and fits each of them from the optimum with
/// the same weights.
///
/// If a record contains at least 3 repeats (`Series::deviations`), the same number of repeats is
/// drawn with replacement, and the replicate is the record + mean of the drawn deviations. This
/// assumes nothing about the noise within a repeat, and retains the model error. The deviations of
/// R repeats from their mean are too small by a factor of sqrt((R - 1) / R), which is corrected.
///
/// For any other condition the replicate is the simulation + residuals drawn in circular blocks,
/// for all channels together. The residuals are scaled up to compensate for the variance that the
/// fit removed. Model errors count as noise here.
///
/// Intervals are percentiles, with their distance from the estimate multiplied by the ratio of the
/// quantiles of Student's t and the normal distribution. The degrees of freedom are combined over
/// the conditions according to Satterthwaite, with R - 1 for each condition with repeats. Stores
/// the results in `fit.parameters`. `fit.bootstrap` then describes how they were obtained,
/// or why there are none. Random numbers depend only on seed, replicate and condition.
///
/// @param found   must include `scatter`
/// @param scores  scores of the problem's conditions at the optimum, in their order
/// @param left    budget of the whole job; a limit on evaluations ends the bootstrap after the same
///                replicate for any number of threads
void bootstrap(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
               const std::vector<ConditionScore>& scores, const FitOptions& options, Fit& fit,
               Budget& left);

}  // namespace rigcal::calib
