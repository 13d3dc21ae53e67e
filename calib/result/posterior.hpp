#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/record.hpp"

// Draws from the posterior of a fit.

namespace rigcal::calib {

/// One parameter over the draws. SI.
struct PosteriorSpread {
  double median = 0.0;
  double sd = 0.0;
  std::optional<Range> ci95;  ///< quantiles of 2.5 and 97.5 %
  double r_hat = 0.0;         ///< rank-normalised, split
  double bulk_draws = 0.0;    ///< effective sample size for the middle
  double tail_draws = 0.0;    ///< and for the ends of intervals
  RIGCAL_DESCRIBE(median, sd, ci95, r_hat, bulk_draws, tail_draws)
};

/// How probable it is that a limit is kept.
struct KeptLimit {
  std::string condition;
  datasets::Channel channel = datasets::Channel::position;
  std::string metric;
  double limit = 0.0;
  double probability = 0.0;  ///< share of the simulated draws that keep it
  double median = 0.0;       ///< median of the metric over these draws
  RIGCAL_DESCRIBE(condition, channel, metric, limit, probability, median)
};

/// Draws for pictures of pairs of parameters: every so-many-th of all, SI.
struct Pairs {
  std::vector<std::string> names;
  int every = 1;
  std::vector<std::vector<double>> values;  ///< shape (names, draws that are kept)
  RIGCAL_DESCRIBE(names, every, values)
};

/// Chains of the no-U-turn sampler, and what is known of them.
struct Posterior {
  int chains = 0;
  int warm_up = 0;  ///< draws of each chain that do not count
  int draws = 0;    ///< draws of each chain that do; 0: of what follows only the message counts
  int asked = 0;    ///< number of them that was asked for
  long evaluations = 0;
  int diverged = 0;  ///< trajectories whose energy error showed that steps are too long
  int longest = 0;   ///< trajectories that were cut off at the most doublings
  double energy_fraction = kUnknown;  ///< least of the chains
  double r_hat = kUnknown;            ///< largest of all unknowns
  double least_draws = kUnknown;      ///< least effective sample size, bulk or tail
  std::optional<std::string> worst;   ///< unknown that has the largest R-hat
  double noise_variance =
      1.0;               ///< variance of a weighted residual outside the estimates' directions
  bool effects = false;  ///< whether small effects that the model leaves out were sampled
  int simulated = 0;     ///< draws from which the limits are judged
  std::vector<KeptLimit> limits;
  Pairs pairs;
  std::string message;  ///< in words: how they were drawn, what is wrong with them
  RIGCAL_DESCRIBE(chains, warm_up, draws, asked, evaluations, diverged, longest, energy_fraction,
                  r_hat, least_draws, worst, noise_variance, effects, simulated, limits, pairs,
                  message)

  std::vector<std::string> names;           ///< names of the unknowns
  std::vector<std::vector<double>> values;  ///< SI, of each unknown: chain after chain

  bool mixed() const { return r_hat <= kMostRHat; }
  static constexpr double kMostRHat = 1.01;
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace rigcal::calib
