#include "report/job/export_choices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/problem/known_values.hpp"
#include "calib/problem/parameter_map.hpp"
#include "calib/problem/simulation_task.hpp"
#include "common/suggest.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/run/validation.hpp"

namespace rigcal::report {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::Scope;
using model::ParameterValues;

/// Lists the leak levels that occur in the campaign or in the fit.
std::vector<std::string> leak_levels(const Campaign& campaign,
                                     const std::optional<EarlierFit>& earlier) {
  std::vector<std::string> levels;
  const auto add = [&levels](const std::string& level) {
    if (std::find(levels.begin(), levels.end(), level) == levels.end()) levels.push_back(level);
  };
  for (const auto& [level, overrides] : campaign.leak_levels) add(level);
  for (const Condition& condition : campaign.conditions) {
    if (condition.leak_level) add(*condition.leak_level);
  }
  if (earlier) {
    for (const datasets::FittedValue& value : earlier->values) {
      if (value.scope == Scope::leak_level) add(value.level);
    }
  }
  return levels;
}

/// Returns the leak level from --level, or the only level that exists; std::nullopt if the rig has
/// no leak levels.
std::optional<std::string> chosen_level(const ExportRequest& request,
                                        const std::vector<std::string>& levels) {
  if (request.level) {
    if (std::find(levels.begin(), levels.end(), *request.level) == levels.end())
      throw UsageError("--level: " + unknown_name_message("leak level", *request.level, levels));
    return request.level;
  }
  if (levels.size() > 1)
    throw UsageError(
        fmt::format("the rig has {} leak levels: expected --level with one of {}, or --condition",
                    levels.size(), fmt::join(levels, ", ")));
  if (levels.empty()) return std::nullopt;
  return levels.front();
}

/// Throws if the fit has no value for the leak level, and names the options that help.
void require_values_of_level(const ExportRequest& request, const Campaign& campaign,
                             const Condition& condition, const EarlierFit& earlier) {
  for (const datasets::FittedValue& value : earlier.values) {
    if (value.scope == Scope::rig || calib::known_in(campaign, condition, value.index)) continue;
    const std::string_view key = model::parameter_spec(campaign.rig.plant, value.index).key;
    if (value.scope == Scope::condition)
      throw UsageError(fmt::format("{}: the fit has a {} for each condition: expected --condition",
                                   request.fit.name(), key));
    std::vector<std::string> levels;
    for (const datasets::FittedValue& other : earlier.values) {
      if (other.index == value.index) levels.push_back(other.level);
    }
    const std::string level = condition.leak_level.value_or("");
    if (std::find(levels.begin(), levels.end(), level) == levels.end())
      throw UsageError(fmt::format(
          "--level {}: {} has no {} for it, only for {}: expected one of these, or a known value "
          "in [leak_level.\"...\"]",
          level, request.fit.name(), key, fmt::join(levels, ", ")));
  }
}

/// Applies the values from --set, which override those of the fit.
void set_over_fit(const std::vector<std::string>& set, const Campaign& campaign,
                  const Condition& condition, ParameterValues& values) {
  for (const std::string& assignment : set) {
    const std::string key = assignment.substr(0, assignment.find('='));
    const int index = model::parameter_index(campaign.rig.plant, key);
    if (!calib::known_in(campaign, condition, index))
      values.set(index, campaign.setting(index)->value);
  }
}

ParameterValues values_of(const std::vector<std::string>& set, const Campaign& campaign,
                          const Condition& condition, const std::optional<EarlierFit>& earlier) {
  ParameterValues values = earlier ? calib::values_with(campaign, condition, earlier->values)
                                   : datasets::values_in(campaign, condition);
  set_over_fit(set, campaign, condition, values);
  if (const auto missing = values.missing(); !missing.empty())
    throw InputError({campaign.file.string()},
                     fmt::format("no value of {} applies to the whole rig: expected --condition "
                                 "with a condition that has them",
                                 fmt::join(missing, ", ")));
  return values;
}

/// Warns about exported values that were not estimated.
void warn_of_start_values(const Campaign& campaign, const Condition& condition,
                          const std::optional<EarlierFit>& earlier,
                          std::vector<std::string>& warnings) {
  std::vector<std::string_view> starts;
  std::vector<std::string_view> of_records;
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, setting.index);
    if (!setting.fit || spec.kind == model::ParameterKind::sensor ||
        calib::known_in(campaign, condition, setting.index))
      continue;
    if (setting.nuisance) {
      of_records.push_back(spec.key);
    } else if (!earlier) {
      starts.push_back(spec.key);
    }
  }
  if (!starts.empty())
    warnings.push_back(
        fmt::format("not calibrated: {} have start values; use --fit fit.json for calibrated ones",
                    fmt::join(starts, ", ")));
  if (!of_records.empty())
    warnings.push_back(
        fmt::format("{} differ from record to record: the campaign's own values are exported",
                    fmt::join(of_records, ", ")));
}

/// Removes the sensors: their initial readings become the initial state.
void take_sensors_off(ParameterValues& values) {
  struct Reading {
    const char* initial;
    const char* gain;
    const char* offset;
  };
  constexpr std::array kReadings{
      Reading{"initial_angle", "angle_gain", "angle_offset"},
      Reading{"initial_position", "position_gain", "position_offset"},
      Reading{"initial_load_pressure", "load_pressure_gain", "load_pressure_offset"},
      Reading{"initial_pressure_a", "pressure_a_gain", "pressure_a_offset"},
      Reading{"initial_pressure_b", "pressure_b_gain", "pressure_b_offset"}};
  for (const Reading& reading : kReadings) {
    if (model::parameter_index(values.plant, reading.initial) < 0) continue;
    const std::string_view initial = reading.initial;
    const bool motion = initial == "initial_position" || initial == "initial_angle";
    if (!motion && !values.is_given(reading.initial)) continue;
    values.set(reading.initial,
               (values[reading.initial] - values[reading.offset]) / values[reading.gain]);
  }
  const auto defaults = ParameterValues::defaults(values.plant);
  const auto table = model::parameter_table(values.plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool sensor = table[i].kind == model::ParameterKind::sensor;
    const bool no_limit = table[i].key == "output_limit" && !std::isfinite(values.value[i]);
    if (!sensor && !no_limit) continue;
    values.value[i] = defaults.value[i];
    values.given[i] = false;
  }
}

/// Removes the transport delay if requested. Otherwise throws if there is a delay.
void take_delay_off(const ExportRequest& request, const Campaign& campaign, ParameterValues& values,
                    std::vector<std::string>& warnings) {
  const double delay_s = values["transport_delay"];
  const char* drive =
      campaign.rig.controller == model::ControllerKind::pid ? "reference" : "command";
  if (delay_s != 0.0 && !request.without_delay)
    throw InputError(
        {campaign.file.string()},
        fmt::format("transport_delay is {:g} s, but the inputs of an FMU act without delay: "
                    "expected --without-delay, and a delay of the {} in the importing model",
                    delay_s, drive));
  if (delay_s != 0.0)
    warnings.push_back(
        fmt::format("transport_delay is left out: delay the {} by {} s in the importing model",
                    drive, delay_s));
  const auto index =
      static_cast<std::size_t>(model::parameter_index(values.plant, "transport_delay"));
  values.value[index] = 0.0;
  values.given[index] = false;
}

bool is_input(const Campaign& campaign, datasets::Channel channel) {
  const auto found = campaign.channels.find(channel);
  return found != campaign.channels.end() && found->second.role == datasets::ChannelRole::input;
}

/// Throws if the base of the rig moves, since the inputs of an FMU are the same for all rigs.
void require_base_at_rest(const Campaign& campaign) {
  if (!is_input(campaign, datasets::Channel::base_acceleration)) return;
  throw InputError({campaign.file.string()},
                   "key 'recording.channels.base_acceleration': an FMU has no such input: expected "
                   "role = \"ignore\", and mass times this acceleration added to the input "
                   "external_force in the importing model");
}

/// Throws if the oil follows a recorded temperature, for the same reason.
void require_constant_temperature(const Campaign& campaign) {
  if (!is_input(campaign, datasets::Channel::temperature)) return;
  throw InputError(
      {campaign.file.string()},
      "key 'recording.channels.temperature': an FMU has no such input: expected role = \"ignore\", "
      "and the parameter oil_temperature, which the importing model may set");
}

/// Throws if the model rejects the values, with the model's own message.
void require_simulable(const Campaign& campaign, const model::ExportedRig& rig) {
  const std::array times_s{0.0};
  const std::array outputs{model::Output::position};
  const auto run = model::simulate(rig.rig, rig.values, {}, {}, times_s, outputs);
  if (!run.ok()) throw InputError({campaign.file.string()}, run.reason);
}

/// Sets the start values of recorded inputs from their first samples; the importer provides the
/// rest of the inputs.
void start_from_record(const calib::SimulationTask& task, ParameterValues& values,
                       std::vector<std::string>& warnings) {
  std::vector<std::string_view> recorded;
  const auto take = [&](const std::optional<model::Signal>& signal, std::string_view key,
                        double beside) {
    if (!signal) return;
    values.set(key, beside + signal->value(task.time_s.front()));
    recorded.push_back(key);
  };
  if (model::parameter_index(values.plant, "external_force") >= 0)
    take(task.inputs.external_load, "external_force", values["external_force"]);
  else if (task.inputs.external_load)
    warnings.push_back(fmt::format(
        "recorded in this condition: torque; the input external_moment starts at 0, and not at the "
        "first sample ({:.4g} N m)",
        task.inputs.external_load->value(task.time_s.front())));
  take(task.inputs.supply_pressure_pa, "supply_pressure", 0.0);
  if (model::parameter_index(values.plant, "tank_pressure") >= 0)
    take(task.inputs.tank_pressure_pa, "tank_pressure", 0.0);
  if (!recorded.empty())
    warnings.push_back(fmt::format(
        "recorded in this condition: {}; the first sample is exported as start value of the input",
        fmt::join(recorded, ", ")));
}

/// Returns the file name without folders, which differ between machines, and the hash.
std::string name_and_hash(const InputFile& file) {
  return fmt::format("{}, SHA-256 {}", std::filesystem::path(file.path).filename().string(),
                     file.sha256);
}

void tell_validity(const calib::Validity& validity,
                   std::vector<std::pair<std::string, std::string>>& origin) {
  const auto add = [&origin](const char* label, const std::optional<Range>& range,
                             std::string_view unit) {
    if (range) origin.emplace_back(label, in_words(*range, unit));
  };
  add("fitted at frequencies of", validity.frequency_hz, "Hz");
  const auto [amplitude, unit] = validity.amplitude();
  add("fitted at amplitudes of", amplitude, unit);
  add("fitted at supply pressures of", validity.supply_pressure_pa, "Pa");
  add("fitted at leakage coefficients of", validity.leakage_coefficient, "1");
  if (!validity.leak_levels.empty())
    origin.emplace_back("fitted at leak levels",
                        fmt::format("{}", fmt::join(validity.leak_levels, ", ")));
}

}  // namespace

ExportChoice choose_export(const Campaign& campaign, const CampaignChoice& choice,
                           const ExportRequest& request) {
  if (request.condition && request.level)
    throw UsageError("found --condition and --level, expected one of them");
  std::optional<EarlierFit> earlier;
  ExportChoice made;
  if (request.fit.given()) {
    earlier = request.fit.read(campaign.rig.plant);
    made.warnings = doubts_about(*earlier, campaign);
  }
  Condition of_level;
  const Condition* condition = &of_level;
  if (request.condition) {
    condition = &chosen_condition(campaign, *request.condition);
  } else {
    of_level.where = {campaign.file.string()};
    of_level.leak_level = chosen_level(request, leak_levels(campaign, earlier));
    if (earlier) require_values_of_level(request, campaign, of_level, *earlier);
  }
  ParameterValues values = values_of(choice.set, campaign, *condition, earlier);
  warn_of_start_values(campaign, *condition, earlier, made.warnings);

  FmuRequest& fmu = made.fmu;
  fmu.rig.rig = campaign.rig;
  fmu.rig.tolerance = campaign.simulation.tolerance.value_or(fmu.rig.tolerance);
  std::vector<datasets::Record> records;
  if (request.condition) {
    calib::SimulationTask task = calib::simulation_task(campaign, *condition, values);
    fmu.rig.rig = task.rig;
    values = task.values;
    start_from_record(task, values, made.warnings);
    fmu.start_s = task.time_s.front();
    fmu.stop_s = task.time_s.back();
    if (task.time_s.size() > 1)
      fmu.step_s = (fmu.stop_s - fmu.start_s) / static_cast<double>(task.time_s.size() - 1);
    if (task.record) records.push_back(std::move(*task.record));
  }
  require_base_at_rest(campaign);
  require_constant_temperature(campaign);
  take_delay_off(request, campaign, values, made.warnings);
  take_sensors_off(values);
  fmu.rig.values = values;
  require_simulable(campaign, fmu.rig);

  made.inputs = hash_inputs(campaign, records, request.fit.inputs());
  fmu.name = campaign.name;
  fmu.identifier =
      fmu_identifier(request.level ? campaign.name + "_" + *request.level : campaign.name);
  auto& origin = fmu.origin;
  origin.emplace_back("rig", campaign.name);
  if (request.condition) origin.emplace_back("condition", condition->id);
  if (condition->leak_level) origin.emplace_back("leak level", *condition->leak_level);
  origin.emplace_back("values from", request.fit.given() ? "a fit" : "the campaign file");
  if (earlier) {
    const std::string verdict(earlier->verdict ? to_string(*earlier->verdict)
                                               : "none, nothing was judged");
    origin.emplace_back("verdict of the fit", verdict);
    if (verdict == "FAIL") made.warnings.emplace_back("the verdict of the fit is FAIL");
    tell_validity(earlier->validity, origin);
  }
  for (const std::string& assignment : choice.set)
    origin.emplace_back("set for the export", assignment);
  for (const InputFile& file : made.inputs) origin.emplace_back("made from", name_and_hash(file));
  for (const std::string& warning : made.warnings) origin.emplace_back("warning", warning);
  return made;
}

}  // namespace rigcal::report
