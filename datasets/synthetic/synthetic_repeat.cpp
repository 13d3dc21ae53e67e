#include "datasets/synthetic/synthetic_repeat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "datasets/synthetic/model_output.hpp"
#include "datasets/synthetic/noise.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kTolerance = 1e-8;
constexpr double kRoomTemperatureK = 293.15;

using Channels = std::map<Channel, std::vector<double>>;

/// Whether a force or torque is the load on the rig rather than the reading of a transducer.
bool is_external_load(const Campaign& campaign, Channel channel) {
  return channel == external_load_channel(campaign) &&
         campaign.channels.at(channel).role == ChannelRole::input;
}

void set_override(Overrides& overrides, int index, double value) {
  const auto found = std::find_if(overrides.begin(), overrides.end(),
                                  [&](const auto& entry) { return entry.first == index; });
  if (found == overrides.end())
    overrides.emplace_back(index, value);
  else
    found->second = value;
}

RepeatFate draw_fate(const Campaign& truth, const Condition& condition, const std::string& repeat,
                     std::uint64_t seed) {
  const SyntheticSettings& settings = *truth.synthetic_settings;
  RepeatFate fate;
  if (settings.trigger_jitter_s > 0.0) {
    auto stream = random_stream(seed, {condition.id, repeat, "trigger"});
    fate.late_s = normal(stream, settings.trigger_jitter_s);
  }
  if (settings.supply_ripple_pa > 0.0) {
    auto stream = random_stream(seed, {condition.id, repeat, "supply ripple"});
    fate.ripple_phase_rad = uniform(stream, 0.0, 2.0 * std::numbers::pi);
  }
  const auto values = values_in(truth, condition);
  const auto table = model::parameter_table(truth.rig.plant);
  for (const auto& [index, relative_sd] : settings.variation) {
    const auto row = static_cast<std::size_t>(index);
    if (!values.given[row])
      throw InputError(condition.where,
                       fmt::format("condition \"{}\": synthetic.variation names {}, which has no "
                                   "value; expected a parameter with a value",
                                   condition.id, table[row].key));
    auto stream = random_stream(seed, {condition.id, repeat, "variation", table[row].key});
    fate.varied.emplace_back(index, values.value[row] * (1.0 + normal(stream, relative_sd)));
  }
  return fate;
}

model::SimulationInputs inputs_with_ripple(const Campaign& truth, const Condition& condition,
                                           const model::ParameterValues& values,
                                           const Record* record, const RepeatFate& fate) {
  auto inputs = inputs_of(truth, condition, values, record);
  const SyntheticSettings& settings = *truth.synthetic_settings;
  if (settings.supply_ripple_pa <= 0.0) return inputs;
  if (inputs.supply_pressure_pa)
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": its supply pressure is recorded; expected no "
                                 "synthetic.supply_ripple, which would replace it",
                                 condition.id));
  inputs.supply_pressure_pa =
      model::Signal::ripple(values["supply_pressure"], settings.supply_ripple_pa,
                            settings.supply_ripple_hz, fate.ripple_phase_rad);
  return inputs;
}

/// Times of the run at the samples of a record that began `late_s` earlier. The first instant of
/// the run represents all times before it. It is always included, because the simulation starts
/// there.
struct RunTimes {
  std::vector<double> run_s;        ///< increasing
  std::vector<std::size_t> sample;  ///< index in run_s for each sample of the record
};

RunTimes run_times(const std::vector<double>& time_s, double late_s) {
  RunTimes times{{time_s.front()}, {}};
  for (const double t : time_s) {
    if (t - late_s > times.run_s.back()) times.run_s.push_back(t - late_s);
    times.sample.push_back(times.run_s.size() - 1);
  }
  return times;
}

/// Simulates the readings of perfect sensors.
Channels clean_channels(const Campaign& truth, const Condition& condition, const Record* record,
                        const std::vector<double>& time_s, const RepeatFate& fate) {
  auto values = values_in(truth, condition);
  for (const auto& [index, value] : fate.varied) values.set(index, value);
  const auto inputs = inputs_with_ripple(truth, condition, values, record, fate);
  const auto channels = made_channels(truth);

  std::vector<model::Output> outputs;
  for (const Channel channel : channels)
    if (const auto output = model_output(channel)) outputs.push_back(*output);
  if (outputs.empty()) outputs.push_back(model::Output::position);
  const RunTimes times = run_times(time_s, fate.late_s);
  model::SimulationOptions options;
  options.method = truth.simulation.method;
  options.tolerance = kTolerance;
  options.max_seconds = truth.simulation.max_seconds;
  const auto run = model::simulate(truth.rig, values, {}, inputs, times.run_s, outputs, options);
  if (!run.ok())
    throw NoResultError(fmt::format("condition \"{}\" could not be simulated: {} at {:.6g} s: {}",
                                    condition.id, model::to_string(run.status), run.failed_at_s,
                                    run.reason));

  const auto value_at = [&](Channel channel, std::size_t i) {
    const double t = time_s[i] - fate.late_s;
    const bool started = t >= time_s.front();
    const double run_s = times.run_s[times.sample[i]];
    if (is_external_load(truth, channel))
      return inputs.external_load ? inputs.external_load->value(run_s) : 0.0;
    if (const auto output = model_output(channel)) {
      const auto column = std::find(outputs.begin(), outputs.end(), *output) - outputs.begin();
      return run.outputs(static_cast<Eigen::Index>(times.sample[i]), column);
    }
    if (channel == drive_channel(truth)) return started ? inputs.drive.value(t) : 0.0;
    if (channel == Channel::base_acceleration)
      return inputs.base_acceleration_m_per_s2 ? inputs.base_acceleration_m_per_s2->value(t) : 0.0;
    if (channel == Channel::supply_pressure)
      return inputs.supply_pressure_pa ? inputs.supply_pressure_pa->value(t)
                                       : values["supply_pressure"];
    if (channel == Channel::tank_pressure) {
      if (inputs.tank_pressure_pa) return inputs.tank_pressure_pa->value(t);
      const bool in_table = model::parameter_index(truth.rig.plant, "tank_pressure") >= 0;
      return in_table ? values["tank_pressure"] : 0.0;
    }
    if (inputs.oil_temperature_k) return inputs.oil_temperature_k->value(t);
    if (values.is_given("oil_temperature")) return values["oil_temperature"];
    return condition.temperature_k.value_or(kRoomTemperatureK);
  };
  Channels result;
  for (const Channel channel : channels) {
    auto& x = result[channel];
    for (std::size_t i = 0; i < time_s.size(); ++i) x.push_back(value_at(channel, i));
  }
  return result;
}

double setting_of(const std::map<Channel, double>& settings, Channel channel) {
  const auto found = settings.find(channel);
  return found == settings.end() ? 0.0 : found->second;
}

/// Adds drift and noise, then applies the converter.
void disturb(std::vector<double>& x, Channel channel, const SyntheticSettings& settings,
             const std::string& condition, const std::string& repeat, std::uint64_t seed) {
  const auto stream_of = [&](std::string_view purpose) {
    return random_stream(seed, {condition, repeat, info(channel).key, purpose});
  };
  const auto add = [&](const std::vector<double>& disturbance) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += disturbance[i];
  };
  if (const double drift = setting_of(settings.drift, channel); drift != 0.0 && x.size() > 1) {
    auto stream = stream_of("drift");
    const double sign = uniform(stream, 0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += sign * drift * static_cast<double>(i) / static_cast<double>(x.size() - 1);
  }
  if (const double sd = setting_of(settings.noise_sd, channel); sd > 0.0) {
    auto stream = stream_of("white");
    add(white_noise(stream, x.size(), sd));
  }
  if (const double sd = setting_of(settings.ar1_sd, channel); sd > 0.0) {
    auto stream = stream_of("ar1");
    add(ar1_noise(stream, x.size(), sd, settings.ar1_coefficient));
  }
  if (const double step = setting_of(settings.quantisation, channel); step > 0.0)
    for (double& value : x) value = quantised(value, step);
}

}  // namespace

Campaign true_campaign(const Campaign& campaign) {
  Campaign truth = campaign;
  if (!campaign.synthetic_settings) return truth;
  for (const auto& [index, value] : campaign.synthetic_settings->parameters) {
    const int row = index;  // clang 14 cannot capture a structured binding
    const auto found = std::find_if(truth.parameters.begin(), truth.parameters.end(),
                                    [&](const auto& setting) { return setting.index == row; });
    if (found == truth.parameters.end()) {
      ParameterSetting added;
      added.index = index;
      added.value = value;
      truth.parameters.push_back(added);
    } else {
      found->value = value;
    }
  }
  for (const auto& [level, overrides] : campaign.synthetic_settings->level_parameters)
    for (const auto& [index, value] : overrides)
      set_override(truth.leak_levels[level], index, value);
  const SyntheticSettings& settings = *campaign.synthetic_settings;
  for (Condition& condition : truth.conditions) {
    if (!condition.duration_s && settings.duration_s > 0.0)
      condition.duration_s = settings.duration_s;
    if (!condition.sample_rate_hz && settings.sample_rate_hz > 0.0)
      condition.sample_rate_hz = settings.sample_rate_hz;
  }
  return truth;
}

std::vector<Channel> made_channels(const Campaign& campaign) {
  std::vector<Channel> channels;
  for (const auto& [channel, setting] : campaign.channels)
    if (!is_drive(channel) || channel == Channel::command || channel == drive_channel(campaign))
      channels.push_back(channel);
  return channels;
}

std::vector<SyntheticRepeat> synthetic_repeats(const Campaign& truth, const Condition& condition,
                                               const Record* record, std::uint64_t seed) {
  const SyntheticSettings& settings = *truth.synthetic_settings;
  const auto time_s = sample_times(condition, record);
  const bool runs_differ = settings.trigger_jitter_s > 0.0 || settings.supply_ripple_pa > 0.0 ||
                           !settings.variation.empty();
  std::vector<SyntheticRepeat> repeats;
  Channels clean;
  for (int number = 1; number <= settings.repeats; ++number) {
    const std::string name = fmt::format("r{}", number);
    SyntheticRepeat repeat;
    repeat.fate = draw_fate(truth, condition, name, seed);
    if (number == 1 || runs_differ)
      clean = clean_channels(truth, condition, record, time_s, repeat.fate);
    repeat.record = {fmt::format("records/{}_{}.csv", condition.id, name), time_s, clean};
    for (auto& [channel, x] : repeat.record.values)
      disturb(x, channel, settings, condition.id, name, seed);
    repeats.push_back(std::move(repeat));
  }
  return repeats;
}

}  // namespace rigcal::datasets
