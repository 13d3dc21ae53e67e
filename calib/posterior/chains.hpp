#pragma once

#include <vector>

// Diagnostics that show whether several chains have converged to the same distribution, and how
// many independent draws they are equivalent to (Vehtari, Gelman, Simpson, Carpenter and Buerkner,
// Bayesian Analysis 16, 2021).

namespace rigcal::calib {

/// Draws of one quantity, shape (chains, draws); all chains have the same length.
using Chains = std::vector<std::vector<double>>;

/// Returns the rank-normalised split R-hat. It is the larger of the value for the ranks and the
/// value for the ranks of the distances from the median. NaN if a chain has fewer than four draws;
/// 1 if all draws are equal.
double split_r_hat(const Chains& chains);

/// Returns the effective sample size for the centre of the distribution, computed from the
/// rank-normalised draws.
double bulk_effective_draws(const Chains& chains);
/// Returns the effective sample size for intervals: the smaller of those for the fractions of draws
/// below the 5 % quantile and below the 95 % quantile.
double tail_effective_draws(const Chains& chains);

/// Estimates the Bayesian fraction of missing information from the energies of one chain: how much
/// of the variation in energy comes from new momenta (Betancourt, arXiv:1604.00695). Below 0.3 the
/// sampler may not reach the tails.
double energy_fraction(const std::vector<double>& energies);

/// Returns a quantile of draws by linear interpolation between their order statistics.
double quantile_of(std::vector<double> draws, double share);

}  // namespace rigcal::calib
