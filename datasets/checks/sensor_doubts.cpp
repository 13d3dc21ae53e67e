#include "datasets/checks/sensor_doubts.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/suggest.hpp"

namespace rigcal::datasets {
namespace {

/// Returns the day of a date, with or without a time. ISO 8601 dates sort as text.
std::string day_part(const std::string& date) { return date.substr(0, 10); }

/// Describes a sensor, as in "the sensor of position (LVDT 12, serial number 0815)".
std::string words_of(const ReportSettings::Fields& sensor) {
  std::string text = fmt::format("the sensor of {}", text_of(sensor, "channel"));
  const std::string instrument = text_of(sensor, "instrument");
  const std::string number = text_of(sensor, "serial_number");
  if (!instrument.empty() && !number.empty())
    return text + fmt::format(" ({}, serial number {})", instrument, number);
  return instrument.empty() ? text : text + fmt::format(" ({})", instrument);
}

/// Returns the first condition that was tested after a day, and the number of such conditions.
std::pair<const Condition*, int> tested_after(const Campaign& campaign, const std::string& day) {
  std::pair<const Condition*, int> result{nullptr, 0};
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == Use::ignore || !condition.date) continue;
    if (day_part(*condition.date) <= day) continue;
    if (result.first == nullptr) result.first = &condition;
    ++result.second;
  }
  return result;
}

void doubt_dates(const Campaign& campaign, const ReportSettings::Fields& sensor,
                 std::vector<SensorDoubt>& doubts) {
  const std::string due = day_part(text_of(sensor, "due"));
  const std::string calibrated = day_part(text_of(sensor, "calibrated"));
  if (due.empty()) return;
  if (!calibrated.empty() && due < calibrated) {
    doubts.push_back({"sensor_dates", true,
                      fmt::format("{} was due on {}, before it was calibrated on {}",
                                  words_of(sensor), due, calibrated)});
  }
  const auto [first, count] = tested_after(campaign, due);
  if (first == nullptr) return;
  doubts.push_back(
      {"sensor_overdue", true,
       fmt::format("{} was due for calibration on {}, and {} was tested on {}{}", words_of(sensor),
                   due, first->id, day_part(*first->date),
                   count == 1 ? "" : fmt::format(", and {} more after that day", count - 1))});
}

void doubt_uncertainty(const Campaign& campaign, const ReportSettings::Fields& sensor,
                       std::vector<SensorDoubt>& doubts) {
  const std::string text = text_of(sensor, "uncertainty");
  const std::string name = text_of(sensor, "channel");
  if (text.empty()) return;
  const auto channel = channel_from_key(name);
  if (!channel) {
    std::vector<std::string> known;
    for (const auto& entry : campaign.channels) known.emplace_back(info(entry.first).key);
    const auto near = nearest_name(name, known);
    if (!near.empty()) {
      doubts.push_back({"sensor_uncertainty", true,
                        fmt::format("the uncertainty of {}, \"{}\", is not used: there is no "
                                    "channel \"{}\" (did you mean \"{}\"?)",
                                    words_of(sensor), text, name, near)});
    }
    return;
  }
  const auto setting = campaign.channels.find(*channel);
  if (setting == campaign.channels.end() || setting->second.role == ChannelRole::ignore) return;
  const StatedUncertainty stated = stated_uncertainty(text, info(*channel).unit);
  if (stated.problem.empty()) return;
  doubts.push_back({"sensor_uncertainty", true,
                    fmt::format("the uncertainty of {}, \"{}\", is not used: {}", words_of(sensor),
                                text, stated.problem)});
}

}  // namespace

std::vector<SensorDoubt> sensor_doubts(const Campaign& campaign) {
  std::vector<SensorDoubt> doubts;
  for (const ReportSettings::Fields& sensor : campaign.report.sensors) {
    doubt_dates(campaign, sensor, doubts);
    doubt_uncertainty(campaign, sensor, doubts);
  }
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.role != ChannelRole::input) continue;
    if (!(setting.gain_sd > 0.0) && !(setting.offset_sd > 0.0)) continue;
    doubts.push_back(
        {"sensor_uncertainty", false,
         fmt::format("the stated uncertainty of {} is not used: it is an input of the model",
                     info(channel).key)});
  }
  return doubts;
}

}  // namespace rigcal::datasets
