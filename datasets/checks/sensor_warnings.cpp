#include "datasets/checks/sensor_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "datasets/checks/stuck_sensor.hpp"

namespace rigcal::datasets {
namespace {

using Kind = SensorFault::Kind;

/// Returns the drive of the rig at each sample; empty if it is unknown.
std::vector<double> drive_of(const Campaign& campaign, const Condition& condition,
                             const Repeat& repeat) {
  const auto recorded = repeat.values.find(drive_channel(campaign));
  if (recorded != repeat.values.end()) return recorded->second;
  if (!is_periodic(condition.waveform)) return {};
  const model::Signal drive =
      inputs_of(campaign, condition, values_in(campaign, condition), nullptr).drive;
  std::vector<double> result(repeat.time_s.size());
  std::transform(repeat.time_s.begin(), repeat.time_s.end(), result.begin(),
                 [&](double t) { return drive.value(t); });
  return result;
}

void find(Channel channel, const Repeat& repeat, const std::vector<double>& drive,
          std::vector<SensorFault>& faults) {
  const std::vector<double>& x = repeat.values.at(channel);
  std::set<std::size_t> reported;  // starts of these runs
  const auto add = [&](Kind kind, const std::vector<EqualRun>& runs) {
    for (const EqualRun& run : runs) {
      if (!reported.insert(run.begin).second) continue;
      faults.push_back({channel,
                        kind,
                        repeat.source,
                        {repeat.time_s[run.begin], repeat.time_s[run.end() - 1]},
                        run.length,
                        run.value});
    }
  };
  add(Kind::clipped_at_highest, clipped_runs(x, drive, RangeEnd::highest));
  add(Kind::clipped_at_lowest, clipped_runs(x, drive, RangeEnd::lowest));
  add(Kind::frozen, frozen_runs(x, drive));
}

bool counts(const SensorFault& fault, const std::vector<TimeWindow>& windows) {
  return windows.empty() || std::any_of(windows.begin(), windows.end(), [&](const auto& window) {
           return fault.stretch.start_s <= window.end_s && fault.stretch.end_s >= window.start_s;
         });
}

std::string_view words(Kind kind) {
  switch (kind) {
    case Kind::clipped_at_highest:
      return "stays at exactly its highest value, as if the sensor or amplifier were saturated";
    case Kind::clipped_at_lowest:
      return "stays at exactly its lowest value, as if the sensor or amplifier were saturated";
    case Kind::frozen:
      break;
  }
  return "does not change while the drive does, as if the sensor or its line were interrupted";
}

std::string text(const std::vector<const SensorFault*>& faults) {
  std::set<std::string_view> repeats;
  std::size_t samples = 0;
  for (const SensorFault* each : faults) {
    repeats.insert(each->source);
    samples += each->samples;
  }
  const SensorFault& longest = **std::max_element(
      faults.begin(), faults.end(),
      [](const SensorFault* a, const SensorFault* b) { return a->samples < b->samples; });
  const ChannelInfo& about = info(longest.channel);
  return fmt::format(
      "{}: {} ({:.6g} {}): {} samples in {} repeat{}, the longest run {} from {:.6g} s to {:.6g} s",
      about.key, words(longest.kind), longest.value, about.unit, samples, repeats.size(),
      repeats.size() == 1 ? "" : "s", longest.source, longest.stretch.start_s,
      longest.stretch.end_s);
}

}  // namespace

std::vector<SensorFault> sensor_faults(const Campaign& campaign, const Condition& condition,
                                       const std::vector<Repeat>& repeats) {
  std::vector<SensorFault> faults;
  for (const Repeat& repeat : repeats) {
    const std::vector<double> drive = drive_of(campaign, condition, repeat);
    for (const ChannelInfo& about : channel_table())
      if (about.is_output && repeat.values.contains(about.channel))
        find(about.channel, repeat, drive, faults);
  }
  return faults;
}

std::vector<std::string> sensor_warnings(const std::vector<SensorFault>& faults,
                                         const std::vector<TimeWindow>& windows) {
  std::vector<std::string> warnings;
  for (const ChannelInfo& about : channel_table()) {
    for (const Kind kind : {Kind::clipped_at_highest, Kind::clipped_at_lowest, Kind::frozen}) {
      std::vector<const SensorFault*> same;
      for (const SensorFault& each : faults)
        if (each.channel == about.channel && each.kind == kind && counts(each, windows))
          same.push_back(&each);
      if (!same.empty()) warnings.push_back(text(same));
    }
  }
  return warnings;
}

}  // namespace rigcal::datasets
