#pragma once

#include <vector>

// Whether several chains have come to the same distribution, and how many independent draws their
// draws are worth (Vehtari, Gelman, Simpson, Carpenter and Buerkner, Bayesian Analysis 16, 2021).

namespace rigcal::calib {

/// Draws of one quantity, shape (chains, draws); all chains of one length.
using Chains = std::vector<std::vector<double>>;

/// Rank-normalised split R-hat: the larger of that of the ranks and that of the ranks of the
/// distances from the median. NaN with fewer than four draws in a chain; 1 where nothing varies.
double split_r_hat(const Chains& chains);

/// Effective sample size of the rank-normalised draws: for the middle of the distribution.
double bulk_effective_draws(const Chains& chains);
/// The lesser of those of the shares below the 5 % and the 95 % quantile: for intervals.
double tail_effective_draws(const Chains& chains);
/// That of the draws as they are: for their mean.
double effective_draws(const Chains& chains);

/// Estimated Bayesian fraction of missing information of one chain's energies: how much of the
/// spread of the energy one new momentum brings (Betancourt, arXiv:1604.00695). Below 0.3 the
/// sampler may not reach the tails.
double energy_fraction(const std::vector<double>& energies);

/// Quantile of draws, linear between their order statistics.
double quantile_of(std::vector<double> draws, double share);

}  // namespace rigcal::calib
