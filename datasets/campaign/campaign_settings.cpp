#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::string_view kWarnPrefix = "warn_";
constexpr const char* kNegligible = "negligible";
constexpr const char* kNotJudged = "not_judged";
/// An offset of more than a second between record and drive is not a day-to-day variation.
constexpr double kMostTriggerSd_s = 1.0;

using metrics::kMetrics;
using metrics::MetricSpec;

const MetricSpec* metric_named(std::string_view name) {
  const auto* row = std::find_if(kMetrics.begin(), kMetrics.end(),
                                 [&](const MetricSpec& metric) { return metric.name == name; });
  return row == kMetrics.end() ? nullptr : row;
}

std::vector<std::string> known_limits() {
  std::vector<std::string> names;
  for (const MetricSpec& row : kMetrics) names.emplace_back(row.name);
  for (const MetricSpec& row : kMetrics) {
    names.push_back(std::string(kWarnPrefix) + std::string(row.name));
  }
  return names;
}

/// Returns the SI units of all channels that can be outputs.
std::vector<std::string> output_units() {
  std::vector<std::string> units;
  for (const std::string& key : output_channel_names()) {
    const std::string unit(info(*channel_from_key(key)).unit);
    if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
  }
  return units;
}

/// @param units  SI units of the channels to which the limits may apply
std::vector<CampaignKey> limit_keys(const std::vector<std::string>& units) {
  std::vector<CampaignKey> keys;
  std::vector<CampaignKey> warnings;
  for (const MetricSpec& metric : kMetrics) {
    KeyForm form = metric.unit == "channel" ? quantity_form(units)
                                            : number_form({metric.lowest, metric.highest});
    if (metric.unit == "channel") form.name = "quantity of the channel";
    const std::string name(metric.name);
    keys.push_back({name,
                    form,
                    fmt::format("Limit of {}; {} is better", metric.formula,
                                metric.higher_is_better ? "higher" : "lower"),
                    {},
                    "no limit"});
    warnings.push_back({std::string(kWarnPrefix) + name,
                        form,
                        "A value between this and the limit is a reservation (WARN)",
                        {},
                        "none"});
  }
  keys.insert(keys.end(), warnings.begin(), warnings.end());
  return keys;
}

KeyForm not_judged_form() {
  return list_form(word_form(output_channel_names()), "list of channels", 0);
}

double read_limit(const TomlNode& node, const MetricSpec& metric, Channel channel) {
  const double value =
      metric.unit == "channel" ? node.difference(info(channel).unit) : node.number();
  if (value < metric.lowest || value > metric.highest) {
    node.fail(fmt::format("{} is out of the range of {}", value, metric.name));
  }
  return value;
}

using Limits = std::vector<AcceptanceLimit>;

AcceptanceLimit& limit_of(Limits& limits, Channel channel, std::string_view metric) {
  for (AcceptanceLimit& entry : limits) {
    if (entry.channel == channel && entry.metric == metric) return entry;
  }
  limits.push_back({channel, std::string(metric), std::nullopt, std::nullopt});
  return limits.back();
}

void read_limit_into(Limits& limits, const TomlNode& node, std::string_view key, Channel channel) {
  const bool warns = key.starts_with(kWarnPrefix);
  const MetricSpec& metric = *metric_named(warns ? key.substr(kWarnPrefix.size()) : key);
  AcceptanceLimit& entry = limit_of(limits, channel, metric.name);
  (warns ? entry.warn : entry.limit) = read_limit(node, metric, channel);
  if (!entry.limit || !entry.warn || *entry.limit == *entry.warn) return;
  if ((*entry.warn > *entry.limit) != metric.higher_is_better) {
    node.fail(fmt::format(
        "warn_{0} is less strict than {0} ({1} is better): expected the warning before the failure",
        metric.name, metric.higher_is_better ? "higher" : "lower"));
  }
}

std::vector<std::pair<Channel, double>> read_channel_values(const TomlNode& table) {
  std::vector<std::pair<Channel, double>> values;
  for (const auto& [key, node] : table.entries()) {
    const Channel channel = read_channel_key(table, key);
    values.emplace_back(channel, node.difference(info(channel).unit, kDisturbances));
  }
  return values;
}

std::map<int, double> read_variation(const TomlNode& table, model::PlantKind plant) {
  std::map<int, double> variation;
  for (const auto& [key, node] : table.entries()) {
    const int index = model::parameter_index(plant, key);
    if (index < 0) table.fail_unknown(key, "parameter", parameter_keys(plant, ParameterGroup::any));
    const double sd = node.number();
    if (sd < 0.0 || sd >= 1.0) {
      node.fail_type("a relative standard deviation, at least 0 and below 1");
    }
    variation[index] = sd;
  }
  return variation;
}

std::map<std::string, Overrides> read_true_levels(const TomlNode& table, model::PlantKind plant) {
  std::map<std::string, Overrides> levels;
  for (const auto& [level, node] : table.entries()) {
    node.allow_only({"parameters"});
    const auto values = node.find("parameters");
    levels[level] = values ? read_overrides(*values, plant, ParameterGroup::rig) : Overrides{};
  }
  return levels;
}

/// Reads the limits from an `acceptance` table. The keys in `others` are not limits.
Limits limits_but(const TomlNode& node, const Campaign& campaign,
                  const std::vector<std::string>& others) {
  std::vector<Channel> outputs = output_channels(campaign);
  const bool has_position = outputs.empty() || std::find(outputs.begin(), outputs.end(),
                                                         motion_channel(campaign)) != outputs.end();
  const std::vector<Channel> general =
      has_position ? std::vector<Channel>{motion_channel(campaign)} : outputs;
  std::vector<std::string> names = known_limits();
  const auto is_limit = [&](const std::string& key) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  Limits limits;
  for (const auto& [key, entry] : node.entries()) {
    if (!is_limit(key)) continue;
    for (const Channel channel : general) read_limit_into(limits, entry, key, channel);
  }
  for (const auto& [key, entry] : node.entries()) {
    if (is_limit(key) || std::find(others.begin(), others.end(), key) != others.end()) continue;
    if (!entry.is_table() || !channel_from_key(key)) {
      names.insert(names.end(), others.begin(), others.end());
      const auto channels = output_channel_names();
      if (entry.is_table()) names.insert(names.begin(), channels.begin(), channels.end());
      node.fail_unknown(key, entry.is_table() ? "channel" : "metric", names);
    }
    const Channel channel = *channel_from_key(key);
    if (std::find(outputs.begin(), outputs.end(), channel) == outputs.end()) {
      entry.fail("is not an output channel: expected one of those in [recording.channels]");
    }
    // Limits in the table of a channel replace the general limits.
    for (const auto& limit : entry.entries()) {
      const std::string& name = limit.first;
      if (!is_limit(name)) entry.fail_unknown(name, "metric", names);
      const std::string metric =
          name.starts_with(kWarnPrefix) ? name.substr(kWarnPrefix.size()) : name;
      std::erase_if(limits, [&](const AcceptanceLimit& old) {
        return old.channel == channel && old.metric == metric;
      });
    }
    for (const auto& [name, limit] : entry.entries()) {
      read_limit_into(limits, limit, name, channel);
    }
  }
  return limits;
}

/// Keys of [acceptance] that are not limits.
const KeyTable<AcceptanceBounds>& bound_keys() {
  using Row = KeyRow<AcceptanceBounds>;
  static const KeyTable<AcceptanceBounds> keys({
      Row::word<DecisionRule>(
          "decision", &AcceptanceBounds::decision,
          {.doc = "How the uncertainty of a score is used. With `guard_band` a score passes "
                  "without reservation only if it meets its limit by more than its uncertainty",
           .example = "\"guard_band\"",
           .hint = "PASS if a limit is met by more than the uncertainty of the score"}),
      Row::number("model_error_to_noise", &AcceptanceBounds::model_error_to_noise, kSizes,
                  {.doc = "Lack of fit accepted without reservation: standard deviation of the "
                          "model error relative to that of the noise of the record's mean"}),
      Row::described(
          kNegligible, known_values_form(ParameterGroup::any),
          {.doc = "Size up to which a parameter is negligible if it is not significantly different "
                  "from zero: `leakage_coefficient = 0.01`",
           .otherwise = "a fifth of the same parameter at another leak level or condition"}),
      Row::described(
          kNotJudged, not_judged_form(),
          {.doc = "Channels that need no limit", .otherwise = "none", .example = "[\"position\"]"}),
  });
  return keys;
}

/// A section that states sizes: a table with a key per quantity, or `false`.
struct SizesSection {
  std::vector<SizedQuantity> (*quantities)(model::PlantKind plant);
  std::string_view noun;     ///< what each key is the name of
  std::string_view without;  ///< meaning of `false` for the section
  std::string_view size;     ///< what a value is
  std::string (*meaning)(const model::ParameterSpec* spec);
  /// Returns the largest size of a quantity. `index` is its parameter, or below 0.
  double (*most)(const TomlNode& entry, const Campaign& campaign, int index,
                 const SizedQuantity& quantity);
};

double most_considered(const TomlNode& entry, const Campaign& campaign, int index,
                       const SizedQuantity& effect) {
  if (index < 0) return effect.unit == "1" ? 1.0 : effect.unit == "Pa" ? 1e9 : 1e3;
  const ParameterSetting* setting = campaign.setting(index);
  if (setting != nullptr && (setting->fit || setting->prior))
    entry.fail("is already in the model, with an estimate or a prior: remove its size here");
  return model::parameter_spec(campaign.rig.plant, index).upper;
}

double most_between_days(const TomlNode& /*entry*/, const Campaign& campaign, int index,
                         const SizedQuantity& /*quantity*/) {
  if (index < 0) return kMostTriggerSd_s;
  const ParameterSetting* setting = campaign.setting(index);
  if (setting != nullptr && setting->value > 0.0) return setting->value;
  return model::parameter_spec(campaign.rig.plant, index).upper;
}

constexpr SizesSection kConsideredSection{
    effect_names,
    "effect",
    "the model is treated as exact",
    "a plausible size",
    [](const model::ParameterSpec* spec) {
      return std::string(spec == nullptr ? "Plausible size of this effect" : spec->meaning);
    },
    most_considered};
constexpr SizesSection kBetweenDaysSection{
    day_quantity_names,
    "quantity",
    "no day differs from another",
    "a standard deviation between days",
    [](const model::ParameterSpec* /*spec*/) {
      return std::string("Standard deviation from one day to another");
    },
    most_between_days};

KeyForm sizes_form(const SizesSection& section) {
  KeyForm left_out = plain_form(KeyForm::Kind::flag);
  KeyForm table = plain_form(KeyForm::Kind::table);
  for (const std::string& name : model::plant_names()) {
    const model::PlantKind plant = model::plant_from_name(name).value();
    for (const SizedQuantity& each : section.quantities(plant)) {
      if (find_key(table.keys, each.key) != nullptr) continue;
      const int index = model::parameter_index(plant, each.key);
      table.keys.push_back(
          {each.key, either_form({quantity_form(each.unit), left_out}, ""),
           section.meaning(index < 0 ? nullptr : &model::parameter_spec(plant, index))});
    }
  }
  return either_form({left_out, std::move(table)}, "table");
}

StatedSizes read_sizes(const TomlNode& node, const Campaign& campaign,
                       const SizesSection& section) {
  StatedSizes stated;
  if (node.is_boolean()) {
    if (node.boolean())
      node.fail(
          fmt::format("is true: expected a table of sizes, or false where {}", section.without));
    stated.none = true;
    return stated;
  }
  const auto quantities = section.quantities(campaign.rig.plant);
  for (const auto& [key, entry] : node.entries()) {
    const auto quantity = std::ranges::find(quantities, key, &SizedQuantity::key);
    if (quantity == quantities.end()) {
      std::vector<std::string> known;
      for (const SizedQuantity& each : quantities) known.push_back(each.key);
      node.fail_unknown(key, section.noun, known);
    }
    const int index = model::parameter_index(campaign.rig.plant, key);
    const double most = section.most(entry, campaign, index, *quantity);
    if (entry.is_boolean()) {
      if (entry.boolean())
        entry.fail(fmt::format("is true: expected {}, or false to leave it out", section.size));
      stated.left_out.insert(key);
      continue;
    }
    const double size = entry.difference(quantity->unit);
    if (!(size > 0.0))
      entry.fail(fmt::format("is not above zero: expected {}, or false", section.size));
    if (!(size <= most))
      entry.fail(fmt::format("is larger than {:g} {}, which it may be at most: expected {}", most,
                             quantity->unit, section.size));
    stated.sizes[key] = size;
  }
  return stated;
}

}  // namespace

std::vector<CampaignKey> limit_keys() {
  std::vector<CampaignKey> keys = limit_keys(output_units());
  for (const std::string& key : output_channel_names()) {
    const std::string unit(info(*channel_from_key(key)).unit);
    keys.push_back({key,
                    table_form(limit_keys({unit})),
                    "Limits of this channel, in place of the general ones",
                    {},
                    "none"});
  }
  keys.push_back({kNotJudged,
                  not_judged_form(),
                  "Channels that need no limit",
                  {},
                  "none",
                  false,
                  "[\"position\"]"});
  return keys;
}

std::vector<CampaignKey> acceptance_keys() {
  std::vector<CampaignKey> keys = limit_keys();
  // bound_keys() has `not_judged`, too.
  keys.erase(std::remove_if(keys.begin(), keys.end(),
                            [](const CampaignKey& row) { return row.key == kNotJudged; }),
             keys.end());
  keys.insert(keys.end(), bound_keys().keys().begin(), bound_keys().keys().end());
  return keys;
}

std::vector<AcceptanceLimit> read_limits(const TomlNode& node, const Campaign& campaign) {
  return limits_but(node, campaign, {kNotJudged});
}

std::vector<Channel> read_not_judged(const TomlNode& node, const Campaign& campaign,
                                     const std::vector<AcceptanceLimit>& limits) {
  std::vector<Channel> channels;
  const auto list = node.find(kNotJudged);
  if (!list) return channels;
  std::vector<std::pair<std::string, Channel>> choices;
  for (const Channel channel : output_channels(campaign))
    choices.emplace_back(info(channel).key, channel);
  for (const TomlNode& item : list->items()) {
    const Channel channel = item.choice(choices);
    const auto limit = std::find_if(limits.begin(), limits.end(), [&](const AcceptanceLimit& each) {
      return each.channel == channel;
    });
    if (limit != limits.end()) {
      item.fail(
          fmt::format("{0} has a limit of {1} in the same table: expected either limits of "
                      "{0}, or its name here",
                      info(channel).key, limit->metric));
    }
    channels.push_back(channel);
  }
  return channels;
}

void read_acceptance(const TomlNode& node, Campaign& campaign) {
  campaign.acceptance = limits_but(node, campaign, bound_keys().names());
  AcceptanceBounds& bounds = campaign.acceptance_bounds;
  bounds.not_judged = read_not_judged(node, campaign, campaign.acceptance);
  bound_keys().read_rows(node, bounds);
  if (const auto table = node.find(kNegligible)) {
    for (const auto& [index, value] :
         read_overrides(*table, campaign.rig.plant, ParameterGroup::any))
      bounds.negligible.emplace(index, std::abs(value));
  }
}

const KeyTable<FitSettings>& fit_keys() {
  using Row = KeyRow<FitSettings>;
  static const KeyTable<FitSettings> keys({
      Row::word<Loss>(
          "loss", &FitSettings::loss,
          {.doc = "Loss of a residual: quadratic, or smaller than that for large residuals"}),
      Row::number("loss_scale", &FitSettings::loss_scale, kSizes,
                  {.doc = "Transition of the loss, in standard deviations of a residual"}),
      Row::whole("max_iterations", &FitSettings::max_iterations, 1, 1'000'000,
                 {.doc = "Maximum number of iterations of a descent"}),
      Row::whole("starts", &FitSettings::starts, 1, 100'000,
                 {.doc = "Number of starts; the first one uses the start values of the campaign"}),
      Row::whole("posterior", &FitSettings::posterior, kLeastPosteriorDraws, kMostPosteriorDraws,
                 {.doc = "Posterior draws in each of four chains; `--posterior N` overrides it",
                  .otherwise = "none"}),
      Row::quantity("max_time", &FitSettings::max_seconds, "s", kDurations_s,
                    {.doc = "Time limit of the whole job, including bootstrap, profiles, posterior "
                            "and cross-validation",
                     .otherwise = "none",
                     .example = "\"60 s\""}),
      Row::described("outputs", list_form(word_form(output_channel_names()), "list of channels"),
                     {.doc = "What is compared with the model",
                      .otherwise = "all outputs",
                      .example = "[\"position\"]"}),
  });
  return keys;
}

FitSettings read_fit(const TomlNode& node, const Campaign& campaign) {
  FitSettings fit;
  if (const auto removed = node.find("shooting_interval"))
    removed->fail(
        "was removed with multiple shooting: expected `starts`, which searches from further start "
        "values");
  fit_keys().read(node, fit);
  const auto outputs = node.find("outputs");
  if (!outputs) return fit;
  Words<Channel> choices;
  for (const Channel channel : output_channels(campaign))
    choices.emplace_back(info(channel).key, channel);
  for (const TomlNode& item : outputs->items()) fit.outputs.push_back(item.choice(choices));
  if (fit.outputs.empty()) outputs->fail("is empty: expected at least one output channel");
  return fit;
}

KeyForm considered_form() { return sizes_form(kConsideredSection); }
StatedSizes read_considered(const TomlNode& node, const Campaign& campaign) {
  return read_sizes(node, campaign, kConsideredSection);
}

KeyForm between_days_form() { return sizes_form(kBetweenDaysSection); }
StatedSizes read_between_days(const TomlNode& node, const Campaign& campaign) {
  return read_sizes(node, campaign, kBetweenDaysSection);
}

const KeyTable<SimulationSettings>& simulation_keys() {
  using Row = KeyRow<SimulationSettings>;
  static const KeyTable<SimulationSettings> keys({
      Row::word<model::Method>(
          "method", &SimulationSettings::method,
          {{"rosenbrock", model::Method::rosenbrock}, {"dopri5", model::Method::dopri5}},
          {.doc = "Implicit, or explicit (`dopri5`), which may need a lower `tolerance`"}),
      Row::number("tolerance", &SimulationSettings::tolerance,
                  NumberLimits{{1e-13, 0.1}, "a relative tolerance from 1e-13 to 0.1"},
                  {.doc = "Relative error of a step",
                   .otherwise = "from the noise of each record (measured for a recorded drive, at "
                                "most 1e-5); results state the smallest",
                   .example = "1e-6"}),
      Row::number("max_seconds", &SimulationSettings::max_seconds, kDurations_s,
                  {.doc = "Wall time of one simulation, in seconds"}),
  });
  return keys;
}

SimulationSettings read_simulation(const TomlNode& node) {
  SimulationSettings simulation;
  simulation_keys().read(node, simulation);
  return simulation;
}

const KeyTable<SyntheticSettings>& synthetic_keys() {
  using Row = KeyRow<SyntheticSettings>;
  using Values = std::map<Channel, double> SyntheticSettings::*;
  const auto by_channel = [](std::string_view key, Values member, const KeyAbout& about) {
    return Row::custom(
        key, channels_form("quantity by channel"),
        [member](const TomlNode& node, SyntheticSettings& synthetic) {
          const auto values = read_channel_values(node);
          synthetic.*member = {values.begin(), values.end()};
        },
        about);
  };
  KeyForm variation = table_form(parameter_rows(ParameterGroup::any, false));
  for (CampaignKey& row : variation.keys) {
    row.form = number_form({0.0, 1.0});
    row.form.below_upper = true;
  }
  variation.name = "number by parameter";
  const KeyForm levels = entries_form(
      table_form({{"parameters", known_values_form(ParameterGroup::rig),
                   "True values at this leak level, which override those of the rig"}}));
  static const KeyTable<SyntheticSettings> keys({
      Row::described(
          "parameters", known_values_form(ParameterGroup::any),
          {.doc = "True values, which override those of the campaign, controller included",
           .otherwise = "`{}`"}),
      Row::described(
          "leak_level", levels,
          {.doc = "`parameters` by leak level: true values at that level", .otherwise = "none"}),
      Row::whole("repeats", &SyntheticSettings::repeats, 1, 10'000, {.doc = "Per condition"}),
      Row::quantity(
          "duration", &SyntheticSettings::duration_s, "s", kDurations_s,
          {.doc = "If a condition states none", .otherwise = "none", .example = "\"10 s\""}),
      Row::quantity(
          "sample_rate", &SyntheticSettings::sample_rate_hz, "Hz", kSampleRates_hz,
          {.doc = "If a condition states none", .otherwise = "none", .example = "\"1 kHz\""}),
      by_channel("noise", &SyntheticSettings::noise_sd,
                 {.doc = "Standard deviation of white noise: `{ position = \"0.05 mm\" }`",
                  .otherwise = "`{}`",
                  .example = "{ position = \"0.05 mm\" }"}),
      by_channel("ar1_noise", &SyntheticSettings::ar1_sd,
                 {.doc = "Standard deviation of coloured noise", .otherwise = "`{}`"}),
      Row::number(
          "ar1_coefficient", &SyntheticSettings::ar1_coefficient,
          NumberLimits{{0.0, 1.0}, "a coefficient per sample, at least 0 and below 1", false, true},
          {.doc = "Correlation of the coloured noise from sample to sample"}),
      by_channel("quantisation", &SyntheticSettings::quantisation,
                 {.doc = "Step of the converter", .otherwise = "`{}`"}),
      by_channel("drift", &SyntheticSettings::drift,
                 {.doc = "Linear over the record, of random sign", .otherwise = "`{}`"}),
      Row::quantity("trigger_jitter", &SyntheticSettings::trigger_jitter_s, "s", kJitters_s,
                    {.doc = "Standard deviation of the start of each repeat"}),
      Row::quantity("supply_ripple", &SyntheticSettings::supply_ripple_pa, "Pa", kDisturbances,
                    {.doc = "Amplitude of a ripple of the supply pressure"}),
      Row::quantity("supply_ripple_frequency", &SyntheticSettings::supply_ripple_hz, "Hz",
                    kFrequencies_hz, {.doc = "Frequency of that ripple"}),
      Row::described("variation", variation,
                     {.doc = "Relative standard deviation between repeats: `{ mass = 0.01 }`",
                      .otherwise = "`{}`",
                      .example = "{ mass = 0.01 }"}),
  });
  return keys;
}

SyntheticSettings read_synthetic(const TomlNode& node, model::PlantKind plant) {
  SyntheticSettings synthetic;
  synthetic_keys().read(node, synthetic);
  if (const auto values = node.find("parameters"))
    synthetic.parameters = read_overrides(*values, plant, ParameterGroup::any);
  if (const auto levels = node.find("leak_level"))
    synthetic.level_parameters = read_true_levels(*levels, plant);
  if (const auto table = node.find("variation"))
    synthetic.variation = read_variation(*table, plant);
  return synthetic;
}

}  // namespace rigcal::datasets
