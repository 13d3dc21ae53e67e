#pragma once

#include <string>

#include "calib/fit.hpp"

namespace rigcal::calib {

/// What a comparison of models needs to know of each fit to the same records.
struct Candidate {
  std::string name;
  double cost = 0.0;  ///< half the sum of squares, the same weights for all candidates
  int parameters = 0;
  double residuals = 0.0;
  double effective_samples = 0.0;
};

Candidate candidate_of(const std::string& name, const Fit& fit);

/// Two models, the smaller one nested in the larger: with the variance of the larger model's
/// residuals as noise, and its effective samples n_e of n residuals,
///
///   L = 2 (cost_small - cost_large) / (2 cost_large / (n - p_large)) * n_e / n
///
/// is chi-square of p_large - p_small degrees of freedom if the smaller one is right; a model whose
/// residuals are correlated gains as much as its share of independent ones allows.
struct ModelChoice {
  double likelihood_ratio = 0.0;  ///< L
  int freedom = 0;
  double p = 1.0;
  double delta_aic = 0.0;  ///< AIC of the larger minus that of the smaller: 2 freedom - L
  double delta_bic = 0.0;  ///< freedom ln(n_e) - L
  bool larger = false;     ///< p below 5 %
  std::string message;     ///< the verdict in words
};

/// @throws std::invalid_argument  `larger` has no more parameters, or other residuals
ModelChoice choose(const Candidate& smaller, const Candidate& larger);

}  // namespace rigcal::calib
