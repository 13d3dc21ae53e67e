#pragma once

#include <vector>

// Diagnostics that show whether several chains have converged to the same distribution, and how
// many independent draws their draws correspond to (Vehtari, Gelman, Simpson, Carpenter and
// Buerkner, Bayesian Analysis 16, 2021).

namespace rigcal::calib {

/// Draws of one quantity, shape (chains, draws); all chains have the same length.
using Chains = std::vector<std::vector<double>>;

/// Returns the rank-normalised split R-hat. It is the larger of two values: one for the ranks, and
/// one for the ranks of the distances from the median. NaN if a chain has fewer than four draws; 1
/// if all draws are equal.
double split_r_hat(const Chains& chains);

/// Returns the effective sample size of the rank-normalised draws, which applies to the centre of
/// the distribution.
double bulk_effective_draws(const Chains& chains);
/// Returns the smaller of the effective sample sizes for the fractions of draws below the 5 % and
/// the 95 % quantile, which applies to intervals.
double tail_effective_draws(const Chains& chains);
/// Returns the effective sample size of the untransformed draws, which applies to their mean.
double effective_draws(const Chains& chains);

/// Returns the estimated Bayesian fraction of missing information from the energies of one chain:
/// how much of the variation in energy a new momentum accounts for (Betancourt, arXiv:1604.00695).
/// Below 0.3 the sampler may not reach the tails.
double energy_fraction(const std::vector<double>& energies);

/// Returns a quantile of draws by linear interpolation between their order statistics.
double quantile_of(std::vector<double> draws, double share);

}  // namespace rigcal::calib
