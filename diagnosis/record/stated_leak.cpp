#include "diagnosis/record/stated_leak.hpp"

#include <algorithm>
#include <string>

#include "common/quantity.hpp"

namespace rigcal::diagnosis {

Keyed<std::optional<double>> no_probabilities() {
  Keyed<std::optional<double>> none;
  for (const LeakClass each : datasets::kLeakClasses)
    none.emplace_back(to_string(each), std::nullopt);
  return none;
}

StatedLeak stated(const LeakEstimate& estimate, double least_probability) {
  StatedLeak leak;
  leak.standard_error = estimate.standard_error;
  if (estimate.standard_error > 0.0) leak.budget = estimate.budget;
  leak.compatible_with_model = std::optional(!estimate.incompatible);
  if (estimate.incompatible) return leak;
  leak.leakage_coefficient = std::max(0.0, estimate.coefficient);
  if (estimate.standard_error > 0.0) leak.ci95 = estimate.ci95;
  leak.leak_flow_l_per_min = kLitresPerMinute * estimate.leak_flow_m3_per_s;
  leak.leak_detected = estimate.leak_detected;
  if (!estimate.has_share()) return leak;
  leak.leak_share_percent = kInPercent * estimate.share;
  leak.leak_share_ci95_percent = kInPercent * estimate.share_ci95;
  if (const auto& limit = estimate.share_upper_limit)
    leak.leak_share_upper_limit_percent = kInPercent * *limit;
  if (estimate.share_budget.combined > 0.0) leak.share_budget = estimate.share_budget;
  for (std::size_t i = 0; i < kClassCount; ++i)
    leak.class_probabilities[i].second = estimate.probability[i];
  if (estimate.probability[static_cast<std::size_t>(estimate.most_probable)] >= least_probability)
    leak.class_ = estimate.most_probable;
  return leak;
}

}  // namespace rigcal::diagnosis
