#include "report/store/stored/stored_record.hpp"

#include <algorithm>

namespace rigcal::report {

long StoredRecord::outliers() const {
  return std::count_if(repeat_reports.begin(), repeat_reports.end(),
                       [](const datasets::RepeatReport& repeat) { return repeat.outlier; });
}

StoredRecord stored(const datasets::Condition& condition, const datasets::Record& record) {
  const auto& time_s = record.time_s;
  const double duration_s = time_s.empty() ? 0.0 : time_s.back() - time_s.front();
  StoredRecord result;
  result.condition = condition.id;
  result.use = condition.use;
  result.samples = static_cast<long>(time_s.size());
  if (duration_s > 0.0) result.sample_rate_hz = static_cast<double>(time_s.size() - 1) / duration_s;
  result.duration_s = duration_s;
  result.repeats = record.repeats;
  for (const FileState& file : record.files) result.files.push_back(file.path);
  for (const datasets::Repeatability& channel : datasets::repeatability(record))
    result.channels.emplace_back(info(channel.channel).key, channel);
  result.offset_range_s = datasets::offset_range_s(record);
  result.repeat_reports = record.repeat_reports;
  for (const datasets::TimeWindow& window : record.windows)
    result.windows_s.push_back({window.start_s, window.end_s});
  result.notes = record.notes;
  result.warnings = record.warnings;
  return result;
}

}  // namespace rigcal::report
