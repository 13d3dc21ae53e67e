#include "calib/trust/model_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/significant.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {

namespace {

/// Residual variance per independent residual of a model, in units of its weights.
struct Noise {
  double variance = 0.0;
  double independent_residuals = 1.0;

  explicit Noise(const Candidate& model)
      : independent_residuals(std::clamp(model.independent_residuals, 1.0, model.residuals)) {
    const double left = model.residuals - model.parameters;
    const double share = independent_residuals / model.residuals;
    variance = left > 0.0 ? 2.0 * model.cost / left / share : 0.0;
  }

  /// Expresses a difference in deviance in terms of independent residuals with this noise.
  double weighed(double difference) const {
    constexpr double kMost = std::numeric_limits<double>::max();
    if (variance > 0.0) return std::clamp(difference / variance, -kMost, kMost);
    return difference == 0.0 ? 0.0 : std::copysign(kMost, difference);
  }
};

/// A smaller difference in a criterion is not worth mentioning (Burnham and Anderson, Model
/// Selection and Multimodel Inference, 2002, 2.6).
constexpr double kNoDifference = 2.0;

/// Formats a number with its sign and three digits, or all digits before the decimal point: "+3.1",
/// "-6936".
std::string signed_text(double value) {
  constexpr double kWhole = 100.0;
  return std::abs(value) < kWhole || std::abs(value) > 1e9 ? fmt::format("{:+.3g}", value)
                                                           : fmt::format("{:+.0f}", value);
}

}  // namespace

InformationDifference compare_information(const Candidate& first, const Candidate& other) {
  if (first.residuals != other.residuals) {
    throw std::invalid_argument(
        fmt::format("compare_information: {} has {} residuals, {} has {}; expected the same",
                    first.name, first.residuals, other.name, other.residuals));
  }
  const Noise noise(other.deviance() < first.deviance() ? other : first);
  const double gain = noise.weighed(other.deviance() - first.deviance());
  const double more = other.parameters - first.parameters;
  InformationDifference result;
  result.aic = 2.0 * more + gain;
  result.bic = more * std::log(noise.independent_residuals) + gain;
  const auto choice = [&](double difference) {
    if (std::abs(difference) < kNoDifference) return 0;
    return difference < 0.0 ? 1 : -1;
  };
  const int by_aic = choice(result.aic);
  const int by_bic = choice(result.bic);
  const std::string numbers =
      fmt::format("AIC {}, BIC {} of {} against {}", signed_text(result.aic),
                  signed_text(result.bic), other.name, first.name);
  if (by_aic == 0 && by_bic == 0) {
    result.message = fmt::format("no relevant difference ({})", numbers);
  } else if (by_aic * by_bic < 0) {
    result.message = fmt::format("the criteria contradict each other ({})", numbers);
  } else {
    result.message =
        fmt::format("{} is preferred ({})", by_aic + by_bic > 0 ? other.name : first.name, numbers);
  }
  return result;
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
  const Noise noise(larger);
  result.likelihood_ratio = noise.weighed(std::max(0.0, smaller.deviance() - larger.deviance()));
  result.p = metrics::chi_squared_exceedance(result.likelihood_ratio, result.freedom);
  result.delta_aic = 2.0 * result.freedom - result.likelihood_ratio;
  result.delta_bic =
      result.freedom * std::log(noise.independent_residuals) - result.likelihood_ratio;
  result.larger = result.p < metrics::kWarningLevel;
  const bool bic_agrees = (result.delta_bic < 0.0) == result.larger;
  result.message = fmt::format(
      "{} is {} by {} (likelihood ratio {} for {} parameter{}, {}; AIC {}, BIC {} of {} against "
      "{}){}",
      result.larger ? larger.name : smaller.name, result.larger ? "preferred" : "good enough",
      larger.independent_residuals < larger.residuals ? "the independent residuals"
                                                      : "all residuals",
      signed_text(result.likelihood_ratio).substr(1), result.freedom,
      result.freedom == 1 ? "" : "s", p_value_text(result.p), signed_text(result.delta_aic),
      signed_text(result.delta_bic), larger.name, smaller.name,
      bic_agrees ? "" : "; BIC disagrees: the choice is not clear");
  return result;
}

}  // namespace rigcal::calib
