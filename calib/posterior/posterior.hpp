#pragma once

#include "calib/posterior/density.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

inline constexpr int kPosteriorChains = 4;
/// Draws of each chain before those that count.
inline constexpr int kPosteriorWarmUp = 300;
/// Draws of a chain that are kept together: a stopped run loses fewer than these.
inline constexpr int kPosteriorStretch = 250;
/// Draws that are simulated to judge the limits.
inline constexpr int kPosteriorSimulated = 200;

/// Samples the posterior of a fit: four chains, each from a point of its own about the optimum, of
/// which the warm-up and every stretch of draws are tasks. Random numbers depend only on the seed,
/// the chain and the number of the draw. A limit of evaluations counts between stretches, so that
/// the draws are the same for any number of threads. Enters the result into `fit.posterior` and
/// `fit.parameters`.
///
/// @param found  uncertainty at the optimum
/// @param left   budget of the whole job; a stretch that it ends is dropped in all chains
void sample_posterior(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                      const FitOptions& options, Fit& fit, Budget& left);

}  // namespace rigcal::calib
