#pragma once

#include <string>

namespace rigcal::calib {

/// A fit that takes part in a comparison of models for the same records.
struct Candidate {
  std::string name;
  double cost = 0.0;  ///< half the sum of squared weighted residuals
  int parameters = 0;
  double residuals = 0.0;
  double independent_residuals = 0.0;
  /// Sum of ln(sd) over the residuals if the fit itself estimated their standard deviations. sd may
  /// be in any unit, provided that all candidates use the same one. 0 if all candidates have the
  /// same weights.
  double log_sd = 0.0;

  /// Returns -2 ln(likelihood) of independent residuals, up to a constant: 2 cost + 2 log_sd.
  double deviance() const { return 2.0 * (cost + log_sd); }
};

/// Compares two models that need not be nested. The noise is estimated from the residual of the
/// model that is closer to the records. With D as the deviance, and n_e of the n residuals counting
/// as independent,
///
///   delta AIC = 2 (p_other - p_first) + (D_other - D_first) / (2 cost / (n - p)) * n_e / n
///
/// and delta BIC has ln(n_e) instead of 2. Using a different fraction n_e / n for each model would
/// favour the worse model, whose residuals are more correlated.
struct InformationDifference {
  double aic = 0.0;     ///< AIC of `other` minus AIC of `first`
  double bic = 0.0;     ///< BIC of `other` minus BIC of `first`
  std::string message;  ///< which model to prefer, in words
};

/// @throws std::invalid_argument  if the models have different residuals
InformationDifference compare_information(const Candidate& first, const Candidate& other);

/// Compares two nested models. The variance of the noise is taken to be the residual variance of
/// the larger model; n_e of its n residuals count as independent. If the smaller model is right,
///
///   L = (D_small - D_large) / (2 cost_large / (n - p_large)) * n_e / n
///
/// has a chi-square distribution with p_large - p_small degrees of freedom. If residuals are
/// correlated, a model gains only in proportion to the number of independent ones. If the smaller
/// model is the larger one with a parameter at a bound, such as zero friction, p is too large by a
/// factor of up to two, which is on the safe side.
struct ModelChoice {
  double likelihood_ratio = 0.0;  ///< the statistic L
  int freedom = 0;                ///< degrees of freedom: additional parameters of the larger model
  double p = 1.0;
  double delta_aic = 0.0;  ///< AIC of the larger minus AIC of the smaller model: 2 `freedom` - L
  double delta_bic = 0.0;  ///< BIC difference: `freedom` ln(n_e) - L
  bool larger = false;     ///< true if the larger model is significantly better (p below 5 %)
  std::string message;     ///< which model to prefer, in words
};

/// @throws std::invalid_argument  if `larger` does not have more parameters, or has different
///                                residuals
ModelChoice choose(const Candidate& smaller, const Candidate& larger);

}  // namespace rigcal::calib
