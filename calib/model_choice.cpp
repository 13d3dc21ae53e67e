#include "calib/model_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace rigcal::calib {

Candidate candidate_of(const std::string& name, const Fit& fit) {
  Candidate candidate;
  candidate.name = name;
  candidate.cost = fit.cost;
  candidate.residuals = static_cast<double>(fit.residual_count);
  candidate.effective_samples =
      fit.effective_samples > 0.0 ? fit.effective_samples : candidate.residuals;
  candidate.parameters = fit.rank;
  return candidate;
}

ModelChoice choose(const Candidate& smaller, const Candidate& larger) {
  if (larger.parameters <= smaller.parameters || larger.residuals != smaller.residuals) {
    throw std::invalid_argument(
        fmt::format("choose: {} must have more parameters than {} and the same residuals; found {} "
                    "and {} parameters, {} and {} residuals",
                    larger.name, smaller.name, larger.parameters, smaller.parameters,
                    larger.residuals, smaller.residuals));
  }
  ModelChoice result;
  result.freedom = larger.parameters - smaller.parameters;
  const double left = larger.residuals - larger.parameters;
  const double variance = left > 0.0 ? 2.0 * larger.cost / left : 0.0;
  const double gain = 2.0 * std::max(0.0, smaller.cost - larger.cost);
  const double share = std::min(1.0, larger.effective_samples / larger.residuals);
  result.likelihood_ratio = variance > 0.0 ? gain / variance * share
                            : gain > 0.0   ? std::numeric_limits<double>::max()
                                           : 0.0;
  const boost::math::chi_squared distribution(result.freedom);
  result.p = boost::math::cdf(boost::math::complement(distribution, result.likelihood_ratio));
  result.delta_aic = 2.0 * result.freedom - result.likelihood_ratio;
  result.delta_bic =
      result.freedom * std::log(std::max(1.0, larger.effective_samples)) - result.likelihood_ratio;
  constexpr double kLevel = 0.05;
  result.larger = result.p < kLevel;
  const bool bic_agrees = (result.delta_bic < 0.0) == result.larger;
  result.message = fmt::format(
      "{} is {} by {} (likelihood ratio {:.3g} for {} parameter{}, p = {:.2g}; AIC {:+.3g}, BIC "
      "{:+.3g}){}",
      result.larger ? larger.name : smaller.name, result.larger ? "preferred" : "good enough",
      larger.effective_samples < larger.residuals ? "the effective samples" : "all residuals",
      result.likelihood_ratio, result.freedom, result.freedom == 1 ? "" : "s", result.p,
      result.delta_aic, result.delta_bic,
      bic_agrees ? "" : "; BIC says otherwise: the case is not clear");
  return result;
}

}  // namespace rigcal::calib
