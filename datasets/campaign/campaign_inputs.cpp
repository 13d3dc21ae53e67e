#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {
namespace {

model::Signal recorded_signal(const Campaign& campaign, const Record& record, Channel channel) {
  const auto& mean = record.channels.at(channel).mean;
  const bool linear = campaign.channels.at(channel).interpolation == Interpolation::linear;
  return linear ? model::Signal::linear(record.time_s, mean)
                : model::Signal::held(record.time_s, mean);
}

double sweep_time(const Condition& condition, const Record* record) {
  if (condition.sweep_s) return *condition.sweep_s;
  if (condition.duration_s) return *condition.duration_s;
  if (record != nullptr && record->time_s.size() > 1) return record->time_s.back();
  throw InputError(condition.where,
                   fmt::format("condition \"{}\": the chirp has no end: expected sweep_time, "
                               "duration or a record",
                               condition.id));
}

model::Signal drive(const Campaign& campaign, const Condition& condition, const Record* record) {
  const double amplitude = condition.amplitude.value_or(0.0);
  const double frequency_hz = condition.frequency_hz.value_or(0.0);
  if (is_periodic(condition.waveform))
    return periodic_signal(condition.waveform, amplitude, frequency_hz);
  if (condition.waveform == Waveform::chirp) {
    return model::Signal::chirp(amplitude, frequency_hz, condition.end_frequency_hz.value(),
                                sweep_time(condition, record), condition.logarithmic_sweep);
  }
  const Channel channel = drive_channel(campaign);
  if (record == nullptr) {
    throw std::invalid_argument(fmt::format(
        "inputs_of: condition \"{}\" has a recorded waveform but no record", condition.id));
  }
  if (!record->channels.contains(channel)) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": its record has no channel {}, which drives the "
                                 "rig where the waveform is \"recorded\"",
                                 condition.id, info(channel).key));
  }
  if (record->generated_drive) return *record->generated_drive;
  return recorded_signal(campaign, *record, channel);
}

/// Returns a measured channel that acts on the rig in addition to the drive, if it was recorded.
std::optional<model::Signal> side_input(const Campaign& campaign, const Record* record,
                                        Channel channel) {
  const auto setting = campaign.channels.find(channel);
  if (setting == campaign.channels.end() || setting->second.role != ChannelRole::input ||
      record == nullptr || !record->channels.contains(channel)) {
    return std::nullopt;
  }
  return recorded_signal(campaign, *record, channel);
}

}  // namespace

model::SimulationInputs inputs_of(const Campaign& campaign, const Condition& condition,
                                  const model::ParameterValues& /*values*/, const Record* record) {
  model::SimulationInputs inputs;
  inputs.drive = drive(campaign, condition, record);
  if (record != nullptr) inputs.drive_begins_s = record->time_s.front();
  inputs.external_load = side_input(campaign, record, external_load_channel(campaign));
  inputs.supply_pressure_pa = side_input(campaign, record, Channel::supply_pressure);
  inputs.tank_pressure_pa = side_input(campaign, record, Channel::tank_pressure);
  inputs.base_acceleration_m_per_s2 = side_input(campaign, record, Channel::base_acceleration);
  inputs.oil_temperature_k = side_input(campaign, record, Channel::temperature);
  return inputs;
}

std::vector<double> sample_times(const Condition& condition, const Record* record) {
  if (record != nullptr) return record->time_s;
  if (!condition.duration_s || !condition.sample_rate_hz) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\" has neither a record nor both duration and "
                                 "sample_rate",
                                 condition.id));
  }
  if (*condition.duration_s * *condition.sample_rate_hz > kMostSamples)
    throw InputError(
        condition.where,
        fmt::format("condition \"{}\": {} s at {} Hz are more than {:.0f} samples", condition.id,
                    *condition.duration_s, *condition.sample_rate_hz, kMostSamples));
  // If the duration is a whole number of intervals, rounding must not drop the last sample.
  constexpr double kSlack = 1e-9;
  const auto intervals = static_cast<std::size_t>(
      std::floor(*condition.duration_s * *condition.sample_rate_hz * (1.0 + kSlack)));
  std::vector<double> times(intervals + 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = static_cast<double>(i) / *condition.sample_rate_hz;
  }
  return times;
}

}  // namespace rigcal::datasets
