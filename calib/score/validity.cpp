#include "calib/score/validity.hpp"

#include <algorithm>
#include <cmath>

#include "model/plant/parameter.hpp"

namespace rigcal::calib {
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

const Record* record_named(const std::vector<Record>& records, const std::string& id) {
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const Record& r) { return r.condition == id; });
  return found == records.end() ? nullptr : &*found;
}

std::optional<Range> recorded_range(const Record* record, Channel channel) {
  if (record == nullptr) return std::nullopt;
  const auto series = record->channels.find(channel);
  if (series == record->channels.end()) return std::nullopt;
  std::optional<Range> range;
  for (const double value : series->second.mean) extend(range, value);
  return range;
}

/// Returns the value of a parameter in a condition, fitted or known. The narrowest scope takes
/// precedence.
double value_in(const Campaign& campaign, const Condition& condition, const Fit& fit,
                std::string_view key) {
  const int index = model::parameter_index(campaign.rig.plant, key);
  double value = datasets::values_in(campaign, condition)[key];
  auto narrowest = datasets::Scope::rig;
  for (const FittedParameter& p : fit.parameters) {
    if (p.index != index || p.scope < narrowest) continue;
    if (p.scope == datasets::Scope::leak_level && p.level != condition.leak_level) continue;
    if (p.scope == datasets::Scope::condition && p.level != condition.id) continue;
    narrowest = p.scope;
    // A value that cannot be distinguished from zero counts as zero rather than, say, 8.8e-07.
    value = p.identifiability == Identifiability::bounded ? 0.0 : p.value;
  }
  return value;
}

}  // namespace

Validity::Amplitude Validity::amplitude() const {
  if (amplitude_n_m) return {amplitude_n_m, "N m"};
  if (amplitude_rad) return {amplitude_rad, "rad"};
  if (amplitude_m_per_s2) return {amplitude_m_per_s2, "m/s2"};
  if (amplitude_pa) return {amplitude_pa, "Pa"};
  if (amplitude_n) return {amplitude_n, "N"};
  if (amplitude_v) return {amplitude_v, "V"};
  return {amplitude_m, "m"};
}

Validity coverage(const Campaign& campaign, const std::vector<Record>& records, const Fit& fit,
                  const std::vector<datasets::Use>& uses) {
  const Channel drive = drive_channel(campaign);
  Validity result;
  std::optional<Range> amplitude;
  for (const Condition& condition : campaign.conditions) {
    if (std::find(uses.begin(), uses.end(), condition.use) == uses.end()) continue;
    const Record* record = record_named(records, condition.id);
    if (condition.frequency_hz) extend(result.frequency_hz, *condition.frequency_hz);
    if (condition.end_frequency_hz) extend(result.frequency_hz, *condition.end_frequency_hz);
    if (condition.amplitude) {
      extend(amplitude, *condition.amplitude);
    } else if (const auto range = recorded_range(record, drive)) {
      extend(amplitude, 0.5 * (range->high - range->low));
    }
    if (const auto range = recorded_range(record, Channel::supply_pressure)) {
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
  put_amplitude(info(drive).unit, amplitude, result);
  return result;
}

}  // namespace rigcal::calib
