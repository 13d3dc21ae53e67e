#pragma once

#include "calib/posterior/density.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

inline constexpr int kPosteriorChains = 4;
/// Number of warm-up draws per chain, which are discarded.
inline constexpr int kPosteriorWarmUp = 300;
/// Number of draws per chain that are stored together; a stopped run loses at most one such group.
inline constexpr int kPosteriorStretch = 250;
/// Largest number of draws that are simulated to judge limits and to compute leak shares.
inline constexpr int kPosteriorSimulated = 200;

/// Samples the posterior of a fit with four chains. Each starts from its own point close to the
/// optimum; the warm-up and every group of draws are separate tasks. Random numbers depend only on
/// the seed, the chain and the number of the draw. The limit on evaluations is checked only between
/// groups, so that the draws are the same for any number of threads. Stores the result in
/// `fit.posterior` and `fit.parameters`.
///
/// @param found    uncertainty at the optimum
/// @param effects  effects whose sizes are drawn with the unknowns; their draws are stored in
///                 `fit.considered`. Null if the model counts as exact
/// @param left     budget of the whole job; if it runs out during a group of draws, that group is
///                 dropped in all chains
void sample_posterior(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                      const EffectLikelihood* effects, const FitOptions& options, Fit& fit,
                      Budget& left);

}  // namespace rigcal::calib
