#include "report/live/live_rig.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calib/problem/known_values.hpp"
#include "common/error.hpp"
#include "report/figure/decimate.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using calib::SimulationTask;
using datasets::Campaign;
using datasets::Condition;
using datasets::Waveform;

constexpr double kPeriodsShown = 4.0;
constexpr double kSecondsOfNoPeriod = 10.0;
/// Maximum number of samples. More would not be visible and would take too long to draw.
constexpr double kMostMadeSamples = 5'000.0;
constexpr double kSamplesOfAPeriod = 500.0;
/// Slider range of a known value without bounds: from a fifth of the value to five times the value.
constexpr double kReach = 5.0;
/// Larger than any leak in the source paper, where the largest coefficient is 2.5.
constexpr double kMostLeakage = 5.0;

const char* const kLeak = "leakage_coefficient";

/// Fills in the duration and sample rate of a generated drive if the campaign does not specify
/// them.
void complete(Condition& condition) {
  if (condition.waveform == Waveform::recorded) return;
  const double frequency_hz = condition.frequency_hz.value_or(0.0);
  if (!condition.duration_s) {
    const bool periodic = is_periodic(condition.waveform) && frequency_hz > 0.0;
    condition.duration_s =
        periodic ? kPeriodsShown / frequency_hz : condition.sweep_s.value_or(kSecondsOfNoPeriod);
  }
  if (!condition.sample_rate_hz) {
    condition.sample_rate_hz =
        std::min(kMostMadeSamples / *condition.duration_s,
                 std::max(kSamplesOfAPeriod * frequency_hz, 100.0 / *condition.duration_s));
  }
}

std::string case_name(const datasets::LeakSignal& signal) {
  return fmt::format("leak table: {}", signal.name());
}

/// Returns the settings of the leak table, if the campaign has one.
std::optional<datasets::LeakTableSettings> leak_table_of(const Campaign& campaign) {
  const bool periodic =
      std::any_of(campaign.conditions.begin(), campaign.conditions.end(),
                  [](const Condition& condition) { return is_periodic(condition.waveform); });
  // Leak tables exist only for position loops and for rigs without a controller.
  if (!periodic || campaign.rig.feedback != model::Feedback::position) return std::nullopt;
  datasets::LeakTableSettings settings = leak_table_settings(campaign);
  if (settings.assumptions.empty()) return std::nullopt;
  return settings;
}

/// Range of a slider and its scale: "log", "linear" or "cubic". The cubic scale can include zero.
struct SliderRange {
  double lower = 0.0;
  double upper = 0.0;
  const char* scale = "linear";
};

SliderRange scaled_range(double lower, double upper) {
  if (lower > 0.0 && upper / lower >= 10.0) return {lower, upper, "log"};
  if (lower == 0.0) return {lower, upper, "cubic"};
  return {lower, upper, "linear"};
}

/// Chooses the slider range. Returns std::nullopt if neither the campaign nor the value suggests
/// one.
std::optional<SliderRange> slider_range(const datasets::ParameterSetting* setting,
                                        const model::ParameterSpec& spec, double value) {
  if (setting != nullptr && std::isfinite(setting->lower) && std::isfinite(setting->upper) &&
      setting->lower < setting->upper)
    return scaled_range(setting->lower, setting->upper);
  if (spec.key == kLeak) return scaled_range(0.0, std::max(kMostLeakage, kReach * value));
  if (value == 0.0) return std::nullopt;
  if (spec.lower < 0.0) return SliderRange{-2.0 * std::abs(value), 2.0 * std::abs(value)};
  return scaled_range(std::max(spec.lower, value / kReach), std::min(spec.upper, value * kReach));
}

const char* group_of(const datasets::ParameterSetting* setting, model::ParameterKind kind) {
  if (setting != nullptr && setting->fit) return "estimates";
  switch (kind) {
    case model::ParameterKind::plant:
    case model::ParameterKind::term:
      return "rig";
    case model::ParameterKind::controller:
      return "controller";
    case model::ParameterKind::sensor:
      return "sensors";
    case model::ParameterKind::initial:
      return "initial";
  }
  return "";
}

/// Describes the quantity that is driven, in the unit of its input field.
Json driven(const Campaign& campaign) {
  const datasets::ChannelInfo& channel = info(datasets::drive_channel(campaign));
  std::string_view unit = channel.unit;
  double si = 1.0;
  if (unit == "m") {
    unit = "mm";
    si = 1e-3;
  } else if (unit == "rad") {
    unit = "deg";
    si = std::numbers::pi / 180.0;
  }
  return {{"name", channel.key}, {"unit", unit}, {"si", si}, {"si_unit", channel.unit}};
}

/// Returns null for numbers that JSON cannot represent.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json live_parameter(const Campaign& campaign, int index, double value) {
  const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, index);
  const datasets::ParameterSetting* setting = campaign.setting(index);
  const auto range = slider_range(setting, spec, value);
  const ReadableUnit unit = readable_unit(value != 0.0 || !range ? value : range->upper, spec.unit);
  const bool bounded = setting != nullptr && setting->fit;
  const PrintedSymbol symbol = printed_symbol(spec.symbol);
  Json row{
      {"index", index},
      {"key", spec.key},
      {"symbol",
       {{"letter", symbol.letter}, {"subscript", symbol.subscript}, {"argument", symbol.argument}}},
      {"meaning", spec.meaning},
      {"group", group_of(setting, spec.kind)},
      {"unit", unit.name},
      {"si", unit.si},
      {"si_unit", spec.unit == "1" ? "" : spec.unit},
      {"lowest", number_or_null(bounded ? setting->lower : spec.lower)},
      {"highest", number_or_null(bounded ? setting->upper : spec.upper)},
      {"slider", nullptr}};
  if (range) {
    row["slider"] = {{"lower", range->lower}, {"upper", range->upper}, {"scale", range->scale}};
  }
  return row;
}

/// Encodes the times and inputs of a recording as 32-bit floats (relative error up to 6e-8).
Json recorded_inputs(const Campaign& campaign, const SimulationTask& task) {
  const datasets::Channel channel = datasets::drive_channel(campaign);
  const auto at_samples = [&task](const model::Signal& signal) {
    std::vector<double> values;
    values.reserve(task.time_s.size());
    for (const double t : task.time_s) values.push_back(signal.value(t));
    return floats_base64(values);
  };
  const auto linear = [&campaign](datasets::Channel of) {
    return campaign.channels.at(of).interpolation == datasets::Interpolation::linear;
  };
  Json json{{"times", doubles_base64(task.time_s)}};
  json["drive"] = {{"linear", linear(channel)}, {"values", at_samples(task.inputs.drive)}};
  const auto add = [&](const char* name, const std::optional<model::Signal>& signal,
                       datasets::Channel of) {
    if (signal) json[name] = {{"linear", linear(of)}, {"values", at_samples(*signal)}};
  };
  add("load", task.inputs.external_load, datasets::external_load_channel(campaign));
  add("supply", task.inputs.supply_pressure_pa, datasets::Channel::supply_pressure);
  add("tank", task.inputs.tank_pressure_pa, datasets::Channel::tank_pressure);
  add("base", task.inputs.base_acceleration_m_per_s2, datasets::Channel::base_acceleration);
  add("temperature", task.inputs.oil_temperature_k, datasets::Channel::temperature);
  return json;
}

Json case_row(const Campaign& campaign, const LiveCase& each) {
  const Condition& condition = each.condition;
  Json row{{"name", each.name},
           {"id", condition.id},
           {"waveform", to_string(condition.waveform)},
           {"initial", static_cast<int>(each.task.rig.initial)},
           {"before", static_cast<int>(each.task.rig.before)},
           {"drive_begins", each.task.inputs.drive_begins_s},
           {"values", given_values(each.task.values)}};
  row["frequency"] = condition.frequency_hz.value_or(1.0);
  row["amplitude"] = condition.amplitude.value_or(0.0);
  if (condition.waveform == Waveform::recorded) {
    row["recorded"] = recorded_inputs(campaign, each.task);
    return row;
  }
  row["duration"] = *condition.duration_s;
  row["rate"] = *condition.sample_rate_hz;
  if (condition.waveform == Waveform::chirp) {
    row["end_frequency"] = condition.end_frequency_hz.value_or(1.0);
    row["sweep"] = condition.sweep_s.value_or(*condition.duration_s);
    row["logarithmic"] = condition.logarithmic_sweep;
  }
  return row;
}

Json preset(std::string_view name, double coefficient) {
  return {{"name", name}, {"coefficient", coefficient}};
}

/// Returns the leak levels for the buttons. They come from the published table, or else from the
/// campaign, or else from the parameters of its synthetic records.
Json presets_of(const Campaign& campaign,
                const std::optional<datasets::LeakTableSettings>& leak_table) {
  Json list = Json::array();
  if (leak_table) {
    for (const datasets::PrintedFeatures& row : leak_table->features)
      if (row.leaking) list.push_back(preset(row.level, row.coefficient));
  }
  const int index = model::parameter_index(campaign.rig.plant, kLeak);
  const auto add = [&](const std::map<std::string, datasets::Overrides>& levels) {
    if (!list.empty()) return;
    for (const auto& [name, overrides] : levels) {
      for (const auto& [of, value] : overrides)
        if (of == index) list.push_back(preset(name, value));
    }
  };
  add(campaign.leak_levels);
  if (campaign.synthetic_settings) add(campaign.synthetic_settings->level_parameters);
  std::stable_sort(list.begin(), list.end(), [](const Json& a, const Json& b) {
    return a.at("coefficient").get<double>() < b.at("coefficient").get<double>();
  });
  return list;
}

/// Returns the rows of the published table of leak levels, which the page recomputes.
///
/// @param comparable  whether the first case is the published drive of the published rig
Json published_levels(const datasets::LeakTableSettings& settings, bool comparable) {
  Json list = Json::array();
  for (const datasets::PrintedFeatures& row : settings.features) {
    Json printed = Json::object();
    for (const auto& [feature, value] : row.printed) {
      if (!comparable) break;
      const bool left_out =
          std::find(row.left_out.begin(), row.left_out.end(), feature) != row.left_out.end();
      printed[std::string(to_string(feature))] = {{"value", value}, {"left_out", left_out}};
    }
    list.push_back({{"name", row.level},
                    {"coefficient", row.coefficient},
                    {"printed", printed},
                    {"reason", row.reason}});
  }
  return list;
}

Json classes_of(const datasets::DiagnosisSettings& settings) {
  Json list = Json::array();
  for (std::size_t i = 0; i < datasets::kLeakClasses.size(); ++i) {
    list.push_back({{"name", to_string(datasets::kLeakClasses[i])},
                    {"below", i < settings.limits.size() ? Json(settings.limits[i]) : nullptr}});
  }
  return list;
}

/// Waveforms that are defined by amplitude and frequency and that the module supports.
Json waveforms_made() { return {"sine", "square", "chirp"}; }

}  // namespace

Json given_values(const model::ParameterValues& values) {
  Json list = Json::array();
  for (std::size_t i = 0; i < values.value.size(); ++i) {
    if (values.given[i] && std::isfinite(values.value[i]))
      list.push_back({static_cast<int>(i), values.value[i]});
  }
  return list;
}

LiveCase live_case(const Campaign& campaign, std::string name, Condition condition,
                   model::ParameterValues values, std::optional<datasets::Record> record) {
  if (!record) complete(condition);
  calib::SimulationTask task =
      calib::simulation_task(campaign, condition, std::move(values), std::move(record));
  if (!condition.duration_s) condition.duration_s = task.time_s.back() - task.time_s.front();
  if (!condition.sample_rate_hz)
    condition.sample_rate_hz =
        static_cast<double>(task.time_s.size() - 1) / (task.time_s.back() - task.time_s.front());
  task.condition = nullptr;  // the condition is moved below, so its address changes
  return {std::move(name), std::move(condition), std::move(task)};
}

std::vector<LiveCase> leak_table_cases(const Campaign& campaign,
                                       const datasets::LeakTableSettings& settings) {
  std::vector<datasets::LeakSignal> signals = settings.signals;
  if (settings.feature_signal) {
    const auto first =
        std::find_if(signals.begin(), signals.end(), [&](const datasets::LeakSignal& signal) {
          return signal.name() == settings.feature_signal->name();
        });
    if (first != signals.end()) std::rotate(signals.begin(), first, first + 1);
  }
  model::ParameterValues values = leak_table_values(campaign, settings);
  values.set(kLeak, settings.features.empty() ? 0.0 : settings.features.back().coefficient);
  for (const datasets::PrintedFeatures& features : settings.features) {
    if (!features.leaking) continue;
    values.set(kLeak, features.coefficient);
    break;
  }
  std::vector<LiveCase> cases;
  for (const datasets::LeakSignal& signal : signals) {
    Condition condition;
    condition.id = signal.name();
    condition.waveform = signal.waveform;
    condition.frequency_hz = signal.frequency_hz;
    condition.amplitude = signal.amplitude;
    condition.where = {campaign.file.string()};
    cases.push_back(live_case(campaign, case_name(signal), std::move(condition), values));
  }
  return cases;
}

std::vector<LiveCase> live_cases(const Campaign& campaign,
                                 const std::vector<datasets::FittedValue>& fitted) {
  std::vector<LiveCase> cases;
  if (const auto settings = fitted.empty() ? leak_table_of(campaign) : std::nullopt)
    cases = leak_table_cases(campaign, *settings);
  std::optional<InputError> problem;
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == datasets::Use::ignore) continue;
    model::ParameterValues values;
    try {
      values = fitted.empty() ? values_in(campaign, condition)
                              : calib::values_with(campaign, condition, fitted);
    } catch (const InputError& error) {  // the fit has no value for this leak level
      if (!problem) problem.emplace(error);
      continue;
    }
    if (const auto missing = values.missing(); !missing.empty()) {
      if (!problem)
        problem.emplace(condition.where,
                        fmt::format("condition \"{}\": {} of the rig is unknown: expected "
                                    "values in [rig.parameters]",
                                    condition.id, fmt::join(missing, ", ")));
      continue;
    }
    if (condition.waveform == Waveform::recorded && !condition.has_record()) {
      if (!problem)
        problem.emplace(condition.where,
                        fmt::format("condition \"{}\": the waveform is \"recorded\", but there "
                                    "is no record; expected repeats or averaged",
                                    condition.id));
      continue;
    }
    cases.push_back(live_case(campaign, condition.id, condition, std::move(values)));
  }
  if (!cases.empty()) return cases;
  if (problem) throw InputError(*problem);
  throw InputError({campaign.file.string()},
                   "no condition to simulate: expected a [[condition]] that is not ignored");
}

Json live_rig(const Campaign& campaign, const std::vector<LiveCase>& cases) {
  const model::SimulationOptions options = calib::simulation_options(campaign);
  const auto leak_table = leak_table_of(campaign);
  Json rig{{"name", campaign.name},
           {"file", campaign.file.filename().string()},
           {"plant", static_cast<int>(campaign.rig.plant)},
           {"controller", static_cast<int>(campaign.rig.controller)},
           {"feedback", static_cast<int>(campaign.rig.feedback)},
           {"driven", driven(campaign)},
           {"method", static_cast<int>(options.method)},
           {"tolerance", options.tolerance},
           {"leak", model::parameter_index(campaign.rig.plant, kLeak)},
           {"waveforms", waveforms_made()},
           {"outputs", Json::array()},
           {"parameters", Json::array()},
           {"cases", Json::array()},
           {"presets", presets_of(campaign, leak_table)},
           {"classes", classes_of(campaign.diagnosis)},
           // Values that --set starts from: the rig without the overrides of any leak level or
           // condition.
           {"campaign", given_values(values_in(campaign, Condition()))}};
  if (leak_table && !leak_table->features.empty()) {
    const bool comparable =
        leak_table->feature_signal && cases.front().name == case_name(*leak_table->feature_signal);
    rig["levels"] = published_levels(*leak_table, comparable);
    const datasets::Assumption* scale = leak_table->assumption(datasets::kResidualScale);
    if (comparable && scale != nullptr) rig["residual_scale"] = scale->value;
  }
  rig["turns"] = campaign.rig.plant == model::PlantKind::linkage;
  rig["has_load_pressure"] = campaign.rig.plant == model::PlantKind::load_pressure;
  for (const model::Output output : model::kAllOutputs)
    rig["outputs"].push_back(model::output_name(output));
  const model::ParameterValues& first = cases.front().task.values;
  for (std::size_t i = 0; i < first.value.size(); ++i) {
    const bool given = std::any_of(cases.begin(), cases.end(), [i](const LiveCase& each) {
      return each.task.values.given[i] && std::isfinite(each.task.values.value[i]);
    });
    if (given)
      rig["parameters"].push_back(live_parameter(campaign, static_cast<int>(i), first.value[i]));
  }
  for (const LiveCase& each : cases) rig["cases"].push_back(case_row(campaign, each));
  return rig;
}

}  // namespace rigcal::report
