#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/record.hpp"

// Draws from the posterior of a fit.

namespace rigcal::calib {

/// Statistics of one parameter over the draws of the posterior, in the unit of the parameter.
struct PosteriorSpread {
  double median = 0.0;        ///< median of the draws
  double sd = 0.0;            ///< standard deviation of the draws
  std::optional<Range> ci95;  ///< 2.5 % and 97.5 % quantiles
  double r_hat = 0.0;         ///< rank-normalised split R-hat; above 1.01 the chains disagree
  double bulk_draws = 0.0;    ///< effective sample size for the centre of the distribution
  double tail_draws = 0.0;    ///< effective sample size for the tails
  RIGCAL_DESCRIBE(median, sd, ci95, r_hat, bulk_draws, tail_draws)
};

/// Probability that a limit is kept.
struct KeptLimit {
  std::string condition;                                    ///< id of the condition
  datasets::Channel channel = datasets::Channel::position;  ///< key of the channel
  std::string metric;                                       ///< name of the metric
  double limit = 0.0;                                       ///< limit of the metric
  double probability = 0.0;  ///< fraction of simulated draws that keep the limit
  double median = 0.0;       ///< median of the metric over these draws
  RIGCAL_DESCRIBE(condition, channel, metric, limit, probability, median)
};

/// Distribution of the share of the servo flow that leaks, over the draws.
struct DrawnShare {
  std::string level;                ///< leak level or condition with the leak; empty for the rig
  std::string condition;            ///< condition for whose motion the share is simulated
  int draws = 0;                    ///< number of draws that could be simulated
  double leak_share_percent = 0.0;  ///< median
  std::optional<Range> leak_share_ci95_percent;  ///< 2.5 % and 97.5 % quantiles
  Keyed<double> class_probabilities;             ///< fraction of the draws in each leak class
  RIGCAL_DESCRIBE(level, condition, draws, leak_share_percent, leak_share_ci95_percent,
                  class_probabilities)
};

/// Thinned draws for plots of parameter pairs: one in `every` draws, SI.
struct Pairs {
  std::vector<std::string> names;           ///< names of the unknowns
  int every = 1;                            ///< number of draws for each one that is kept
  std::vector<std::vector<double>> values;  ///< shape (names, kept draws)
  RIGCAL_DESCRIBE(names, every, values)
};

/// Chains of the no-U-turn sampler with their diagnostics.
struct Posterior {
  int chains = 0;        ///< number of chains
  int warm_up = 0;       ///< number of draws per chain that are discarded
  int draws = 0;         ///< number of draws per chain that are used; if 0, only `message` is valid
  int asked = 0;         ///< number of draws per chain that were requested
  long evaluations = 0;  ///< number of evaluations of all residuals
  /// Number of trajectories whose energy error shows that the steps are too long.
  int diverged = 0;
  int longest = 0;  ///< number of trajectories cut off at the maximum number of doublings
  double energy_fraction = kUnknown;  ///< smallest value of any chain
  double r_hat = kUnknown;            ///< largest value of any unknown
  double least_draws = kUnknown;      ///< smallest effective sample size, bulk or tail
  std::optional<std::string> worst;   ///< the unknown with the largest R-hat
  /// Variance of the weighted residuals in directions that do not affect the estimates.
  double noise_variance = 1.0;
  bool effects = false;  ///< whether the small effects that the model omits were sampled as well
  int simulated = 0;     ///< number of draws simulated for the limits and the shares
  std::vector<KeptLimit> limits;          ///< one for each limit of the campaign
  Later<std::vector<DrawnShare>> shares;  ///< one for each free leakage coefficient
  Pairs pairs;                            ///< draws for plots of parameter pairs
  std::string message;  ///< how the chains were drawn, and any problem with them, in words
  RIGCAL_DESCRIBE(chains, warm_up, draws, asked, evaluations, diverged, longest, energy_fraction,
                  r_hat, least_draws, worst, noise_variance, effects, simulated, limits, shares,
                  pairs, message)

  std::vector<std::string> names;           ///< names of the unknowns
  std::vector<std::vector<double>> values;  ///< all draws of each unknown, chain by chain, SI

  bool mixed() const { return r_hat <= kMostRHat; }
  static constexpr double kMostRHat = 1.01;
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace rigcal::calib
