#pragma once

#include <string>

namespace rigcal::calib {

/// What a comparison of models needs to know of each fit to the same records.
struct Candidate {
  std::string name;
  double cost = 0.0;  ///< half the sum of squared weighted residuals
  int parameters = 0;
  double residuals = 0.0;
  double independent_residuals = 0.0;
  /// Sum over the residuals of ln(sd) where the fit itself estimated what they are divided by; sd
  /// in any unit, the same for all candidates. 0 where the weights are the same for all.
  double log_sd = 0.0;

  /// -2 ln(likelihood) of independent residuals but for a constant: 2 cost + 2 log_sd.
  double deviance() const { return 2.0 * (cost + log_sd); }
};

/// Two models, neither of which need contain the other. The noise is what the one that comes nearer
/// to the records leaves, D its deviance, n_e of n residuals its independent ones:
///
///   delta AIC = 2 (p_other - p_first) + (D_other - D_first) / (2 cost / (n - p)) * n_e / n
///
/// and likewise delta BIC with ln(n_e) for 2. A share of its own for each model would favour the
/// worse one, whose residuals are the more correlated.
struct InformationDifference {
  double aic = 0.0;     ///< of `other` minus that of `first`
  double bic = 0.0;     ///< likewise
  std::string message;  ///< which one is to be preferred, in words
};

/// @throws std::invalid_argument  other residuals
InformationDifference compare_information(const Candidate& first, const Candidate& other);

/// Two models, the smaller one nested in the larger: with the variance of the larger model's
/// residuals as noise, and its n_e independent ones of n residuals,
///
///   L = (D_small - D_large) / (2 cost_large / (n - p_large)) * n_e / n
///
/// is chi-square of p_large - p_small degrees of freedom if the smaller one is right; a model whose
/// residuals are correlated gains as much as its share of independent ones allows. Where the larger
/// one is the smaller one at a bound of its own, as a friction of zero is, p is too large by up to
/// a factor of two: on the safe side.
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
