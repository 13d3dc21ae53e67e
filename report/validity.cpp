#include "report/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/parameter.hpp"

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

/// Value that holds in a condition after the fit; the narrower scope wins.
double value_in(const Campaign& campaign, const Condition& condition, const calib::Fit& fit,
                std::string_view key) {
  const int index = model::parameter_index(campaign.rig.plant, key);
  double value = datasets::values_in(campaign, condition)[key];
  auto narrowest = datasets::Scope::rig;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (p.index != index || !p.fitted || p.scope < narrowest) continue;
    if (p.scope == datasets::Scope::leak_level && p.level != condition.leak_level) continue;
    if (p.scope == datasets::Scope::condition && p.level != condition.id) continue;
    narrowest = p.scope;
    value = p.value;
  }
  return value;
}

void compare(std::vector<std::string>& result, std::string_view what, std::string_view unit,
             const std::optional<Range>& asked, const std::optional<Range>& covered) {
  if (!asked || !covered) return;
  const double slack = 0.01 * std::max(std::abs(covered->low), std::abs(covered->high));
  if (asked->low >= covered->low - slack && asked->high <= covered->high + slack) return;
  result.push_back(
      fmt::format("{} {:.4g} to {:.4g}{} lies outside what the fit covers, {:.4g} to {:.4g}{}",
                  what, asked->low, asked->high, unit, covered->low, covered->high, unit));
}

}  // namespace

Validity coverage(const Campaign& campaign, const std::vector<Record>& records,
                  const calib::Fit& fit, const std::vector<datasets::Use>& uses) {
  const Channel drive =
      campaign.rig.controller == model::ControllerKind::pid ? Channel::reference : Channel::command;
  Validity result;
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

std::vector<std::string> outside(const Validity& asked, const Validity& covered) {
  std::vector<std::string> result;
  compare(result, "frequency", " Hz", asked.frequency_hz, covered.frequency_hz);
  compare(result, "amplitude", " (SI)", asked.amplitude, covered.amplitude);
  compare(result, "supply pressure", " Pa", asked.supply_pressure_pa, covered.supply_pressure_pa);
  compare(result, "leakage coefficient", "", asked.leakage_coefficient,
          covered.leakage_coefficient);
  return result;
}

}  // namespace rigcal::report
