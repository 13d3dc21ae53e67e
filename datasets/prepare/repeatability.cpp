#include "datasets/prepare/repeatability.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::datasets {
namespace {

std::optional<metrics::NoiseFloor> noise_floor_of(const Series& series) {
  const bool constant = std::all_of(series.mean.begin(), series.mean.end(),
                                    [&](double value) { return value == series.mean.front(); });
  if (std::isnan(series.sd_of_mean) || constant) return std::nullopt;
  return metrics::noise_floor(series.mean, series.sd_of_mean);
}

}  // namespace

std::vector<Repeatability> repeatability(const Record& record) {
  std::vector<Repeatability> result;
  for (const auto& [channel, series] : record.channels)
    result.push_back({channel, std::string(info(channel).unit), series.repeats, series.pooled_sd,
                      series.sd_of_mean, noise_floor_of(series)});
  return result;
}

double offset_range_s(const Record& record) {
  if (record.repeat_reports.empty()) return 0.0;
  const auto [earliest, latest] = std::minmax_element(
      record.repeat_reports.begin(), record.repeat_reports.end(),
      [](const RepeatReport& a, const RepeatReport& b) { return a.offset_s < b.offset_s; });
  return latest->offset_s - earliest->offset_s;
}

std::vector<std::string> outliers(const Record& record) {
  std::vector<std::string> sources;
  for (const RepeatReport& report : record.repeat_reports)
    if (report.outlier) sources.push_back(report.source);
  return sources;
}

}  // namespace rigcal::datasets
