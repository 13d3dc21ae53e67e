#include "datasets/checks/short_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace rigcal::datasets {
namespace {

// Thresholds for the row "a record that ends early" in docs/campaign-records.md.
constexpr double kStatedShare = 0.95;
constexpr double kEquallyLong = 0.95;  // fraction of the longest
constexpr double kShareOfLongest = 0.75;
constexpr long kFewestAsLong = 2;

/// Identifies a generated signal. Conditions with the same signal have the same key.
using Signal = std::tuple<Waveform, std::optional<double>, std::optional<double>,
                          std::optional<double>, std::optional<double>>;

Signal signal_of(const Condition& condition) {
  return {condition.waveform, condition.frequency_hz, condition.end_frequency_hz, condition.sweep_s,
          condition.amplitude};
}

/// Usual length of the records of one signal: the longest, provided that enough others are as long.
struct Usual {
  double seconds = 0.0;
  long as_long = 0;
};

std::optional<Usual> usual_length(const std::vector<double>& seconds) {
  const double longest = *std::max_element(seconds.begin(), seconds.end());
  const auto count = [&](double share) {
    return std::count_if(seconds.begin(), seconds.end(),
                         [&](double own) { return own >= share * longest; });
  };
  const long as_long = count(kEquallyLong);
  const long shorter = static_cast<long>(seconds.size()) - count(kShareOfLongest);
  if (as_long < kFewestAsLong || as_long <= shorter) return std::nullopt;
  return Usual{longest, as_long};
}

}  // namespace

std::vector<std::string> short_records(const std::vector<RecordLength>& lengths) {
  std::map<Signal, std::vector<double>> by_signal;
  for (const RecordLength& each : lengths)
    if (each.condition->waveform != Waveform::recorded)
      by_signal[signal_of(*each.condition)].push_back(each.seconds);
  std::map<Signal, std::optional<Usual>> usual;
  for (const auto& [signal, seconds] : by_signal) usual[signal] = usual_length(seconds);

  std::vector<std::string> warnings;
  for (const RecordLength& own : lengths) {
    std::string& text = warnings.emplace_back();
    const auto stated = own.condition->duration_s;
    const auto others = usual.find(signal_of(*own.condition));
    if (stated && own.seconds < kStatedShare * *stated)
      text = fmt::format("the record ends after {:.4g} s of the {:.4g} s that the campaign states",
                         own.seconds, *stated);
    else if (others != usual.end() && others->second &&
             own.seconds < kShareOfLongest * others->second->seconds)
      text = fmt::format(
          "the record ends after {:.4g} s, where {} other conditions of the same signal last "
          "{:.4g} "
          "s",
          own.seconds, others->second->as_long, others->second->seconds);
  }
  return warnings;
}

double seconds_of(const Record& record) { return record.time_s.back() - record.time_s.front(); }

void warn_of_short_records(const Campaign& campaign, const std::vector<Record*>& records) {
  std::vector<RecordLength> lengths;
  for (const Record* record : records) {
    lengths.push_back({campaign.find(record->condition), seconds_of(*record)});
  }
  const auto warnings = short_records(lengths);
  for (std::size_t i = 0; i < records.size(); ++i)
    if (!warnings[i].empty()) records[i]->warnings.push_back(warnings[i]);
}

}  // namespace rigcal::datasets
