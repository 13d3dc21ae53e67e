#include "report/leak/leak_estimate.hpp"

#include <algorithm>
#include <string>

namespace rigcal::report {

Range scaled_ends(const Range& range, double scale) {
  return {scale * range.low, scale * range.high};
}

StoredLeak stored(const diagnosis::LeakEstimate& estimate,
                  const std::optional<datasets::LeakClass>& leak_class, bool ok) {
  StoredLeak leak;
  for (std::size_t i = 0; i < diagnosis::kClassCount; ++i) {
    leak.class_probabilities.emplace_back(
        to_string(datasets::kLeakClasses[i]),
        ok && estimate.has_class() ? std::optional(estimate.probability[i]) : std::nullopt);
  }
  if (!ok) return leak;
  leak.standard_error = estimate.standard_error;
  if (estimate.standard_error > 0.0) leak.budget = estimate.budget;
  leak.compatible_with_model = std::optional(!estimate.incompatible);
  if (estimate.incompatible) return leak;
  leak.leakage_coefficient = std::max(0.0, estimate.coefficient);
  if (estimate.standard_error > 0.0) leak.ci95 = scaled_ends(estimate.ci95);
  leak.leak_flow_l_per_min = kLitresPerMinute * estimate.leak_flow_m3_per_s;
  leak.leak_detected = estimate.leak_detected;
  if (!estimate.has_share()) return leak;
  leak.leak_share_percent = kInPercent * estimate.share;
  leak.leak_share_ci95_percent = scaled_ends(estimate.share_ci95, kInPercent);
  if (const auto& limit = estimate.share_upper_limit)
    leak.leak_share_upper_limit_percent = kInPercent * *limit;
  if (estimate.share_budget.combined > 0.0) leak.share_budget = estimate.share_budget;
  leak.class_ = leak_class;
  return leak;
}

}  // namespace rigcal::report
