#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/record.hpp"

// Draws from the posterior of a fit.

namespace rigcal::calib {

/// One parameter over the draws. SI.
struct PosteriorSpread {
  double median = 0.0;
  double sd = 0.0;
  std::pair<double, double> ci95{};  ///< quantiles of 2.5 and 97.5 %
  double r_hat = 0.0;                ///< rank-normalised, split
  double bulk_draws = 0.0;           ///< effective sample size for the middle
  double tail_draws = 0.0;           ///< and for the ends of intervals
};

/// How probable it is that a limit is kept.
struct KeptLimit {
  std::string condition;
  datasets::Channel channel = datasets::Channel::position;
  std::string metric;
  double limit = 0.0;
  double probability = 0.0;  ///< share of the simulated draws that keep it
  double median = 0.0;       ///< median of the metric over these draws
};

/// Chains of the no-U-turn sampler, and what is known of them.
struct Posterior {
  int chains = 0;
  int warm_up = 0;  ///< draws of each chain that do not count
  int draws = 0;    ///< draws of each chain that do
  int asked = 0;    ///< number of them that was asked for
  long evaluations = 0;
  int diverged = 0;              ///< trajectories whose energy error showed that steps are too long
  int longest = 0;               ///< trajectories that were cut off at the most doublings
  double energy_fraction = 0.0;  ///< least of the chains
  double noise_variance =
      1.0;                   ///< variance of a weighted residual outside the estimates' directions
  double r_hat = 0.0;        ///< largest of all unknowns
  std::string worst;         ///< unknown that has it
  double least_draws = 0.0;  ///< least effective sample size, bulk or tail
  std::vector<std::string> names;           ///< names of the unknowns
  std::vector<std::vector<double>> values;  ///< SI, of each unknown: chain after chain
  int simulated = 0;                        ///< draws from which the limits are judged
  std::vector<KeptLimit> limits;
  std::string message;  ///< in words: how they were drawn, what is wrong with them

  bool mixed() const { return r_hat <= kMostRHat; }
  static constexpr double kMostRHat = 1.01;
};

}  // namespace rigcal::calib
