#include "report/run/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>
#include <vector>

#include "datasets/checks/sensor_doubts.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/store/stored/stored_record.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Output of `check --json`.
struct StoredCheck {
  std::string campaign;
  bool synthetic = false;
  std::vector<StoredRecord> records;
  std::vector<std::string> without_record;
  std::vector<std::string> warnings;  ///< warnings about the campaign as a whole
  RIGCAL_DESCRIBE(campaign, synthetic, records, without_record, warnings)
};

/// Formats one line about a record, and one for each of its warnings.
std::string record_text(const datasets::Condition& condition, const datasets::Record& record) {
  const double duration_s =
      record.time_s.empty() ? 0.0 : record.time_s.back() - record.time_s.front();
  const double rate_hz =
      duration_s > 0.0 ? static_cast<double>(record.time_s.size() - 1) / duration_s : 0.0;
  std::string channels;
  for (const auto& [channel, series] : record.channels) {
    const datasets::ChannelInfo& about = info(channel);
    channels += fmt::format(
        "{}{} ({}sd {})", channels.empty() ? "" : ", ", about.key,
        series.repeats == record.repeats ? "" : fmt::format("{} repeats, ", series.repeats),
        std::isfinite(series.pooled_sd) ? readable(series.pooled_sd, about.unit, 3) : "unknown");
  }
  std::string text =
      fmt::format("{}: {}, {} samples at {:.6g} Hz, {:.6g} s, {} repeat{}, {}, {} file{}\n",
                  condition.id, to_string(condition.use), record.time_s.size(), rate_hz, duration_s,
                  record.repeats, record.repeats == 1 ? "" : "s", channels, record.files.size(),
                  record.files.size() == 1 ? "" : "s");
  for (const std::string& note : record.notes) text += fmt::format("  note: {}\n", note);
  for (const std::string& warning : record.warnings) {
    text += fmt::format("  warning: {}\n", warning);
  }
  return text;
}

}  // namespace

Check check(const datasets::Campaign& campaign, const std::function<void(datasets::Record)>& keep) {
  StoredCheck result;
  result.campaign = campaign.name;
  result.synthetic = campaign.synthetic;
  std::vector<std::string> texts;               // one per condition
  std::vector<datasets::RecordLength> lengths;  // lengths of the conditions that have a record
  std::vector<std::size_t> places;              // indices of these conditions in `texts`
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!condition.has_record()) {
      texts.push_back(fmt::format("{}: {}, no record\n", condition.id, to_string(condition.use)));
      result.without_record.push_back(condition.id);
      continue;
    }
    // Only one record is in memory at a time.
    datasets::Record record = datasets::load_record(campaign, condition);
    lengths.push_back({&condition, datasets::seconds_of(record)});
    places.push_back(texts.size());
    texts.push_back(record_text(condition, record));
    result.records.push_back(stored(condition, record));
    if (keep) keep(std::move(record));
  }
  const std::vector<std::string> warnings = datasets::short_records(lengths);
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    if (warnings[i].empty()) continue;
    texts[places[i]] += fmt::format("  warning: {}\n", warnings[i]);
    result.records[i].warnings.push_back(warnings[i]);
  }
  std::string text = fmt::format("{}", fmt::join(texts, ""));
  for (const datasets::SensorDoubt& doubt : datasets::sensor_doubts(campaign)) {
    text += fmt::format("{}: {}\n", doubt.grave ? "warning" : "note", doubt.words);
    if (doubt.grave) result.warnings.push_back(doubt.words);
  }
  if (campaign.synthetic) text += "note: the records of this campaign are synthetic\n";
  return {std::move(text), json_of(result)};
}

}  // namespace rigcal::report
