#include "report/store/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/plant/parameter.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::Record;

void extend(std::optional<Range>& range, double value) {
  if (!std::isfinite(value)) return;
  if (!range) range = Range{value, value};
  range->low = std::min(range->low, value);
  range->high = std::max(range->high, value);
}

const Record* record_of(const std::vector<Record>& records, const std::string& id) {
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const Record& r) { return r.condition == id; });
  return found == records.end() ? nullptr : &*found;
}

std::optional<Range> range_of(const Record* record, Channel channel) {
  if (record == nullptr) return std::nullopt;
  const auto series = record->channels.find(channel);
  if (series == record->channels.end()) return std::nullopt;
  std::optional<Range> range;
  for (const double value : series->second.mean) extend(range, value);
  return range;
}

/// Value in a condition, fitted or known; the narrower scope wins.
double value_in(const Campaign& campaign, const Condition& condition, const calib::Fit& fit,
                std::string_view key) {
  const int index = model::parameter_index(campaign.rig.plant, key);
  double value = datasets::values_in(campaign, condition)[key];
  auto narrowest = datasets::Scope::rig;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (p.index != index || p.scope < narrowest) continue;
    if (p.scope == datasets::Scope::leak_level && p.level != condition.leak_level) continue;
    if (p.scope == datasets::Scope::condition && p.level != condition.id) continue;
    narrowest = p.scope;
    // A value that is not distinguishable from zero counts as zero, not as 8.8e-07.
    value = p.identifiability == calib::Identifiability::bounded ? 0.0 : p.value;
  }
  return value;
}

/// How far a range may exceed the covered one before it matters, as a fraction of the bound.
constexpr double kSlack = 0.1;

void compare(std::vector<std::string>& result, std::string_view what, std::string_view unit,
             const std::optional<Range>& asked, const std::optional<Range>& covered,
             const std::optional<Range>& validated) {
  if (!asked || !covered) return;
  const bool below = asked->low < covered->low - kSlack * std::abs(covered->low);
  const bool above = asked->high > covered->high + kSlack * std::abs(covered->high);
  if (!below && !above) return;
  result.push_back(
      fmt::format("{} {} is used, but the fit covers only {}{}", what, in_words(*asked, unit),
                  in_words(*covered, unit),
                  validated ? fmt::format(", validated at {}", in_words(*validated, unit)) : ""));
}

}  // namespace

std::string in_words(const Range& range, std::string_view unit) {
  const ReadableUnit readable = readable_unit(range.high, unit);
  const auto number = [&](double value) { return fmt::format("{:.4g}", value / readable.si); };
  const std::string low = number(range.low);
  const std::string high = number(range.high);
  const std::string suffix = readable.name.empty() ? "" : fmt::format(" {}", readable.name);
  return low == high ? high + suffix : fmt::format("{} to {}{}", low, high, suffix);
}

Validity coverage(const Campaign& campaign, const std::vector<Record>& records,
                  const calib::Fit& fit, const std::vector<datasets::Use>& uses) {
  const Channel drive = drive_channel(campaign);
  Validity result;
  result.amplitude_unit = info(drive).unit;
  for (const Condition& condition : campaign.conditions) {
    if (std::find(uses.begin(), uses.end(), condition.use) == uses.end()) continue;
    const Record* record = record_of(records, condition.id);
    if (condition.frequency_hz) extend(result.frequency_hz, *condition.frequency_hz);
    if (condition.end_frequency_hz) extend(result.frequency_hz, *condition.end_frequency_hz);
    if (condition.amplitude) {
      extend(result.amplitude, *condition.amplitude);
    } else if (const auto range = range_of(record, drive)) {
      extend(result.amplitude, 0.5 * (range->high - range->low));
    }
    if (const auto range = range_of(record, Channel::supply_pressure)) {
      extend(result.supply_pressure_pa, range->low);
      extend(result.supply_pressure_pa, range->high);
    } else {
      extend(result.supply_pressure_pa, value_in(campaign, condition, fit, "supply_pressure"));
    }
    extend(result.leakage_coefficient, value_in(campaign, condition, fit, "leakage_coefficient"));
    if (condition.leak_level && std::find(result.leak_levels.begin(), result.leak_levels.end(),
                                          *condition.leak_level) == result.leak_levels.end()) {
      result.leak_levels.push_back(*condition.leak_level);
    }
  }
  return result;
}

std::vector<std::string> outside(const Validity& asked, const Validity& covered,
                                 const Validity* validated) {
  std::vector<std::string> result;
  const auto add = [&](std::optional<Range> Validity::*range, std::string_view what,
                       std::string_view unit) {
    compare(result, what, unit, asked.*range, covered.*range,
            validated != nullptr ? validated->*range : std::nullopt);
  };
  add(&Validity::frequency_hz, "frequency", "Hz");
  add(&Validity::amplitude, "amplitude", asked.amplitude_unit);
  add(&Validity::supply_pressure_pa, "supply pressure", "Pa");
  add(&Validity::leakage_coefficient, "leakage coefficient", "1");
  return result;
}

}  // namespace rigcal::report
