#include "diagnosis/record/healthy_reference.hpp"

#include <algorithm>

namespace rigcal::diagnosis {
namespace {

/// Returns the residual of a record at the sample that is nearest to a time.
double at_time(const std::vector<double>& residual, const std::vector<double>& time_s, double t) {
  const auto above = std::lower_bound(time_s.begin(), time_s.end(), t);
  auto i = static_cast<std::size_t>(above - time_s.begin());
  if (i == time_s.size() || (i > 0 && t - time_s[i - 1] < time_s[i] - t)) --i;
  return residual[i];
}

}  // namespace

void take_off(std::span<const TimedResidual> healthy, datasets::Record& record) {
  for (auto& [channel, series] : record.channels) {
    std::vector<double> sum(record.time_s.size(), 0.0);
    for (const TimedResidual& each : healthy) {
      const auto residual = each.channels->find(channel);
      if (residual == each.channels->end()) continue;
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += at_time(residual->second, *each.time_s, record.time_s[i]);
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
      series.mean[i] -= sum[i] / static_cast<double>(healthy.size());
  }
}

metrics::ResidualFeatures features_within(const std::vector<double>& residual,
                                          const std::vector<double>& time_s,
                                          const std::optional<datasets::TimeWindow>& covered) {
  std::vector<double> counted;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (!covered || (time_s[i] >= covered->start_s && time_s[i] <= covered->end_s))
      counted.push_back(residual[i]);
  }
  return metrics::residual_features(counted);
}

}  // namespace rigcal::diagnosis
