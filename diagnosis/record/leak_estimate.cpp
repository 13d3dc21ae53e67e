#include "diagnosis/record/leak_estimate.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "metrics/distributions.hpp"
#include "metrics/significance.hpp"

namespace rigcal::diagnosis {
namespace {

/// Numbers of equally probable values for the coefficient and for the error of the share. Class
/// probabilities thus have a resolution of 1 / 6015.
constexpr int kDraws = 401;
constexpr int kBlurs = 15;
/// Smaller errors are due to rounding.
constexpr double kLeastShareError = 1e-7;
/// Tolerance for a quantile of the share, and the maximum number of steps for finding it.
constexpr double kQuantileError = 1e-15;
constexpr int kQuantileSteps = 120;

double squared(double x) { return x * x; }

/// Distribution of the share that follows from the distribution of the coefficient. It consists of
/// equally probable shares, each blurred by the error due to the rig's parameters.
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
    std::sort(shares_.begin(), shares_.end());
  }

  /// Calls `take` with equally probable shares, including the blur, which may make them negative.
  template <typename Take>
  void for_each(Take take) const {
    std::array<double, kBlurs> blurs{};
    for (std::size_t k = 0; k < blurs.size(); ++k)
      blurs.at(k) = blur_ * metrics::normal_quantile((static_cast<double>(k) + 0.5) / kBlurs);
    for (const double share : shares_) {
      for (const double blur : blurs) take(share + blur);
    }
  }

  /// Returns the share that is exceeded with probability 1 - p, given that it is not negative.
  /// Newton's method starts at the share with the corresponding rank, and each step narrows the
  /// bounds. If the blur is small, the distribution is a staircase, so that a step may lead beyond
  /// the bounds; it is then replaced by bisection.
  double quantile(double p) const {
    double low = 0.0;
    double high = std::min(1.0, shares_.back() + 10.0 * blur_);
    const double none = raw_below(0.0);
    if (!(none < 1.0)) return low;
    const double wanted = none + p * (1.0 - none);
    const auto rank = static_cast<std::size_t>(wanted * static_cast<double>(shares_.size()));
    double x = std::clamp(shares_[std::min(rank, shares_.size() - 1)], low, high);
    for (int i = 0; i < kQuantileSteps && high - low > kQuantileError; ++i) {
      const double excess = raw_below(x) - wanted;
      (excess < 0.0 ? low : high) = x;
      const double next = x - excess / density(x);
      const double last = x;
      x = next > low && next < high ? next : 0.5 * (low + high);
      if (std::abs(x - last) <= kQuantileError) break;
    }
    return x;
  }

 private:
  double raw_below(double x) const {
    double sum = 0.0;
    for (const double share : shares_) sum += metrics::normal_cdf((x - share) / blur_);
    return sum / static_cast<double>(shares_.size());
  }

  /// Returns the derivative of raw_below() with respect to x.
  double density(double x) const {
    double sum = 0.0;
    for (const double share : shares_) sum += std::exp(-0.5 * squared((x - share) / blur_));
    return sum * std::numbers::inv_sqrtpi / std::numbers::sqrt2 /
           (blur_ * static_cast<double>(shares_.size()));
  }

  double blur_;
  std::vector<double> shares_;
};

/// Prior density of a share, up to a factor: 1 / (offset + share), which decreases and has no step
/// at any limit. The offset makes a normal machine as probable as one with a slight leak: (offset +
/// first)^2 = offset (offset + second), where `first` and `second` are the limits of the classes.
/// If the second limit is less than twice the first, no offset achieves this, and all shares are
/// equally probable.
class Prior {
 public:
  explicit Prior(const datasets::DiagnosisSettings& settings) {
    const double first = settings.limits[0];
    const double room = settings.limits[1] - 2.0 * first;
    if (room > 0.0) offset_ = first * first / room;
  }
  double density(double share) const { return offset_ ? *offset_ / (*offset_ + share) : 1.0; }

 private:
  std::optional<double> offset_;
};

std::array<double, kClassCount> class_probabilities(const ShareDistribution& shares,
                                                    const datasets::DiagnosisSettings& settings) {
  const Prior prior(settings);
  std::array<double, kClassCount> probability{};
  shares.for_each([&](double share) {
    if (share >= 0.0)
      probability[static_cast<std::size_t>(class_of(settings, share))] += prior.density(share);
  });
  const double sum = std::accumulate(probability.begin(), probability.end(), 0.0);
  for (double& each : probability) each /= sum;
  return probability;
}

/// Sets the 95 % interval of the coefficient. If no leak is detected, the upper limit is that of
/// the distribution truncated at 0, so that it is above 0 even for a very negative estimate.
void set_interval(double half_width, LeakEstimate& estimate) {
  const double coefficient = estimate.coefficient;
  if (estimate.leak_detected || estimate.incompatible || !(estimate.standard_error > 0.0)) {
    estimate.ci95 = {coefficient - half_width, coefficient + half_width};
    if (!estimate.incompatible) estimate.ci95.low = std::max(0.0, estimate.ci95.low);
    return;
  }
  const double above_zero = metrics::student_t_cdf(estimate.leak_score, estimate.freedom);
  const double quantile = metrics::student_t_quantile(0.05 * above_zero, estimate.freedom);
  estimate.ci95 = {0.0, coefficient - quantile * estimate.standard_error};
}

}  // namespace

double CoefficientError::total() const { return std::hypot(own_se, rig_se, days_se); }

double CoefficientError::half_width() const {
  return metrics::student_t_quantile(0.975, freedom) * total();
}

CoefficientError coefficient_error(const LeakFit& fit, const SignalErrors& errors, int repeats,
                                   int reference) {
  CoefficientError error;
  std::vector<metrics::ErrorPart> parts;
  double own_variance = 0.0;
  const auto add = [&](const char* source, const metrics::ErrorPart& part) {
    parts.push_back(part);
    own_variance += part.variance;
    error.own.push_back({source, "records", std::sqrt(part.variance)});
  };
  if (is_coloured(fit, errors)) {
    add("lack_of_fit", {squared(fit.cluster_se), static_cast<double>(fit.cluster_freedom)});
  } else {
    add("noise", {squared(fit.white_se), static_cast<double>(fit.white_freedom)});
  }
  if (errors.between_m && fit.effect_m > 0.0) {
    const double means = 1.0 / repeats + (reference > 0 ? 1.0 / reference : 0.0);
    add("repeats", {squared(*errors.between_m / fit.effect_m) * means,
                    static_cast<double>(std::max(1, errors.repeat_freedom))});
  }
  if (errors.healthy_m && reference == 0 && fit.effect_m > 0.0)
    add("healthy_records", {squared(*errors.healthy_m / fit.effect_m)});
  parts.push_back({squared(fit.rig_se)});
  error.own_se = std::sqrt(own_variance);
  error.rig_se = fit.rig_se;
  error.freedom = metrics::effective_freedom(parts);
  return error;
}

std::optional<CoefficientError> error_of_averages(const LeakFit& fit, const SignalErrors& errors,
                                                  int repeats, int reference) {
  if (!errors.repeat_m || !(fit.effect_m > 0.0) || reference < 1) return std::nullopt;
  const double of_both = 1.0 / repeats + 1.0 / reference;
  const auto part = [&](double square_m2, double freedom) {
    return metrics::ErrorPart{square_m2 / squared(fit.effect_m) * of_both, freedom};
  };
  // The samples of all repeats determine the noise. The variation between a few repeats beyond it
  // is uncertain.
  const std::array parts{
      part(squared(errors.repeat_noise_m) * errors.residual_ratio, errors.residual_freedom),
      part(squared(errors.between_m.value_or(0.0)), std::max(1, errors.repeat_freedom)),
      metrics::ErrorPart{squared(fit.rig_se)}};
  return CoefficientError{std::sqrt(parts[0].variance + parts[1].variance), fit.rig_se,
                          metrics::effective_freedom(parts)};
}

LeakEstimate estimate_leak(double coefficient, const CoefficientError& error,
                           const LeakCurve& curve, double share_rig_se,
                           const datasets::DiagnosisSettings& settings) {
  LeakEstimate estimate;
  estimate.coefficient = coefficient;
  estimate.standard_error = error.total();
  estimate.freedom = error.freedom;
  estimate.share = curve.share(coefficient);
  estimate.leak_flow_m3_per_s = curve.leak_flow_m3_per_s(coefficient);
  estimate.share_slope = curve.share_slope(coefficient);

  const ShareDistribution shares(estimate, error.own_se, share_rig_se, curve);
  estimate.share_ci95 = {shares.quantile(0.025), shares.quantile(0.975)};
  estimate.probability = class_probabilities(shares, settings);
  const auto best = std::max_element(estimate.probability.begin(), estimate.probability.end());
  estimate.most_probable =
      datasets::kLeakClasses[static_cast<std::size_t>(best - estimate.probability.begin())];
  if (estimate.standard_error > 0.0) {
    const double alarm = metrics::student_t_quantile(1.0 - settings.false_alarms, estimate.freedom);
    estimate.leak_score = estimate.coefficient / estimate.standard_error;
    estimate.leak_detected = estimate.leak_score > alarm;
    estimate.incompatible = estimate.leak_score < -alarm;
  }
  set_interval(error.half_width(), estimate);
  if (!estimate.leak_detected) {
    estimate.share_upper_limit = shares.quantile(0.95);
    estimate.share_ci95 = {0.0, *estimate.share_upper_limit};
  }
  return estimate;
}

double detection_limit(const CoefficientError& healthy,
                       const datasets::DiagnosisSettings& settings) {
  return healthy.total() *
         (metrics::student_t_quantile(1.0 - settings.false_alarms, healthy.freedom) +
          metrics::student_t_quantile(settings.detection, healthy.freedom));
}

void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept) {
  if (!kept || limit.leak_flow_m3_per_s > kept->leak_flow_m3_per_s) kept = limit;
}

}  // namespace rigcal::diagnosis
