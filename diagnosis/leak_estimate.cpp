#include "diagnosis/leak_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

constexpr int kDraws = 401;
/// Below this an error is that of the arithmetic.
constexpr double kLeastShareError = 1e-7;

struct ErrorPart {
  double variance = 0.0;
  double freedom = 1e9;
};

/// Welch and Satterthwaite.
double effective_freedom(const std::vector<ErrorPart>& parts) {
  double sum = 0.0;
  double weighted = 0.0;
  for (const ErrorPart& part : parts) {
    sum += part.variance;
    weighted += part.variance * part.variance / part.freedom;
  }
  return weighted > 0.0 ? std::clamp(sum * sum / weighted, 1.0, 1e6) : 1e6;
}

/// The share given what is known of the coefficient: equally probable shares, each blurred by the
/// error that comes from the rig's parameters.
class ShareDistribution {
 public:
  ShareDistribution(const LeakEstimate& estimate, double own_se, double rig_se,
                    const LeakCurve& curve)
      : blur_(std::max(rig_se, kLeastShareError)) {
    const double below_zero =
        own_se > 0.0 ? metrics::student_t_cdf(-estimate.coefficient / own_se, estimate.freedom)
                     : 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const double p = below_zero + (1.0 - below_zero) * (i + 0.5) / kDraws;
      const double coefficient =
          p < 1.0 ? estimate.coefficient + own_se * metrics::student_t_quantile(p, estimate.freedom)
                  : 0.0;
      shares_.push_back(curve.share(std::max(0.0, coefficient)));
    }
  }

  /// Probability of a share below x, given that it is not negative.
  double below(double x) const {
    const double none = raw_below(0.0);
    return none < 1.0 ? (raw_below(x) - none) / (1.0 - none) : 1.0;
  }

  double quantile(double p) const {
    double low = 0.0;
    double high = *std::max_element(shares_.begin(), shares_.end()) + 10.0 * blur_;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (below(middle) < p ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  double raw_below(double x) const {
    double sum = 0.0;
    for (const double share : shares_) sum += metrics::normal_cdf((x - share) / blur_);
    return sum / static_cast<double>(shares_.size());
  }

  double blur_;
  std::vector<double> shares_;
};

double squared(double x) { return x * x; }

/// Beforehand a normal machine is as probable as one with a slight leak; apart from that every
/// share is as probable as any other.
std::array<double, kClassCount> class_probabilities(const ShareDistribution& shares,
                                                    const datasets::DiagnosisSettings& settings) {
  std::array<double, kClassCount> probability{};
  double before = 0.0;
  for (std::size_t i = 0; i < kClassCount; ++i) {
    const double up_to = i < settings.limits.size() ? shares.below(settings.limits[i]) : 1.0;
    probability[i] = std::max(0.0, up_to - before);
    before = up_to;
  }
  probability[0] *= (settings.limits[1] - settings.limits[0]) / settings.limits[0];
  const double sum = std::accumulate(probability.begin(), probability.end(), 0.0);
  for (double& each : probability) each /= sum;
  return probability;
}

}  // namespace

LeakEstimate estimate_leak(const LeakFit& fit, const LeakCurve& curve, const SignalErrors& errors,
                           int repeats, int reference,
                           const datasets::DiagnosisSettings& settings) {
  std::vector<ErrorPart> parts{{squared(fit.scatter_se), static_cast<double>(fit.scatter_freedom)}};
  if (errors.repeat_m && fit.effect_m > 0.0) {
    const double means = 1.0 / repeats + (reference > 0 ? 1.0 / reference : 0.0);
    parts.push_back({squared(*errors.repeat_m / fit.effect_m) * means,
                     static_cast<double>(std::max(1, errors.repeat_freedom))});
  }
  if (errors.healthy_m && reference == 0 && fit.effect_m > 0.0)
    parts.push_back({squared(*errors.healthy_m / fit.effect_m)});
  double own_variance = 0.0;
  for (const ErrorPart& part : parts) own_variance += part.variance;
  parts.push_back({squared(fit.rig_se)});

  LeakEstimate estimate;
  estimate.coefficient = fit.coefficient;
  estimate.standard_error = std::sqrt(own_variance + squared(fit.rig_se));
  estimate.freedom = effective_freedom(parts);
  const double half =
      metrics::student_t_quantile(0.975, estimate.freedom) * estimate.standard_error;
  estimate.ci95 = {std::max(0.0, fit.coefficient - half), std::max(0.0, fit.coefficient + half)};
  estimate.share = curve.share(fit.coefficient);
  estimate.leak_flow_m3_per_s = curve.leak_flow_m3_per_s(fit.coefficient);

  const ShareDistribution shares(estimate, std::sqrt(own_variance), fit.share_rig_se, curve);
  estimate.share_ci95 = {shares.quantile(0.025), shares.quantile(0.975)};
  estimate.probability = class_probabilities(shares, settings);
  const auto best = std::max_element(estimate.probability.begin(), estimate.probability.end());
  estimate.most_probable =
      datasets::kLeakClasses[static_cast<std::size_t>(best - estimate.probability.begin())];
  if (estimate.standard_error > 0.0) {
    estimate.leak_score = estimate.coefficient / estimate.standard_error;
    estimate.leak_detected =
        estimate.leak_score >
        metrics::student_t_quantile(1.0 - settings.false_alarms, estimate.freedom);
  }
  return estimate;
}

DetectionLimit detection_limit(const LeakEstimate& healthy, const LeakCurve& curve,
                               const datasets::DiagnosisSettings& settings) {
  const double errors = metrics::student_t_quantile(1.0 - settings.false_alarms, healthy.freedom) +
                        metrics::student_t_quantile(settings.detection, healthy.freedom);
  DetectionLimit limit;
  limit.coefficient = errors * healthy.standard_error;
  limit.leak_flow_m3_per_s = curve.leak_flow_m3_per_s(limit.coefficient);
  limit.share = curve.share(limit.coefficient);
  return limit;
}

void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept) {
  if (!kept || limit.leak_flow_m3_per_s > kept->leak_flow_m3_per_s) kept = limit;
}

}  // namespace rigcal::diagnosis
