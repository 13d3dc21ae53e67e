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
  StoredRecord told;
  told.condition = condition.id;
  told.use = condition.use;
  told.samples = static_cast<long>(time_s.size());
  if (duration_s > 0.0) told.sample_rate_hz = static_cast<double>(time_s.size() - 1) / duration_s;
  told.duration_s = duration_s;
  told.repeats = record.repeats;
  for (const FileState& file : record.files) told.files.push_back(file.path);
  for (const datasets::Repeatability& channel : datasets::repeatability(record))
    told.channels.emplace_back(info(channel.channel).key, channel);
  told.offset_range_s = datasets::offset_range_s(record);
  told.repeat_reports = record.repeat_reports;
  for (const datasets::TimeWindow& window : record.windows)
    told.windows_s.push_back({window.start_s, window.end_s});
  told.notes = record.notes;
  told.warnings = record.warnings;
  return told;
}

}  // namespace rigcal::report
