#pragma once

#include <string>

namespace rigcal::calib {

/// A fit in a comparison of models for the same records.
struct Candidate {
  std::string name;
  double cost = 0.0;  ///< half the sum of squared weighted residuals
  int parameters = 0;
  double residuals = 0.0;
  double independent_residuals = 0.0;
  /// Sum over the residuals of ln(sd) if the fit itself estimated the divisors of the residuals; sd
  /// in any unit, the same for all candidates. 0 if the weights are the same for all.
  double log_sd = 0.0;

  /// -2 ln(likelihood) of independent residuals but for a constant: 2 cost + 2 log_sd.
  double deviance() const { return 2.0 * (cost + log_sd); }
};

/// Compares two models that need not be nested. The noise is the residual of the one that is closer
/// to the records, D its deviance, n_e of n residuals are independent:
///
///   delta AIC = 2 (p_other - p_first) + (D_other - D_first) / (2 cost / (n - p)) * n_e / n
///
/// and delta BIC with ln(n_e) in place of 2. A fraction n_e / n of its own for each model would
/// favour the worse one, whose residuals are more correlated.
struct InformationDifference {
  double aic = 0.0;     ///< AIC of `other` minus that of `first`
  double bic = 0.0;     ///< likewise, with ln(n_e)
  std::string message;  ///< which model to prefer, in words
};

/// @throws std::invalid_argument  other residuals
InformationDifference compare_information(const Candidate& first, const Candidate& other);

/// Compares two nested models. With the variance of the larger model's residuals as noise, and its
/// n_e independent ones of n residuals,
///
///   L = (D_small - D_large) / (2 cost_large / (n - p_large)) * n_e / n
///
/// is chi-square with p_large - p_small degrees of freedom if the smaller one is right. A model
/// with correlated residuals gains only in proportion to its independent ones. If the smaller model
/// is the larger one at a bound, such as a friction of zero, p is too large by up to a factor of
/// two, which is on the safe side.
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
