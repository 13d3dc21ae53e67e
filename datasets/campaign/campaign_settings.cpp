#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::string_view kWarnPrefix = "warn_";
constexpr const char* kDecision = "decision";
constexpr const char* kModelError = "model_error_to_noise";
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

/// Reads one limit of a channel.
void read_limit_into(Limits& limits, const TomlNode& node, std::string_view key, Channel channel) {
  const bool warns = key.starts_with(kWarnPrefix);
  const MetricSpec& metric = *metric_named(warns ? key.substr(kWarnPrefix.size()) : key);
  AcceptanceLimit& entry = limit_of(limits, channel, metric.name);
  (warns ? entry.warn : entry.limit) = read_limit(node, metric, channel);
  if (!entry.limit || !entry.warn || *entry.limit == *entry.warn) return;
  if ((*entry.warn > *entry.limit) != metric.higher_is_better) {
    node.fail(
        fmt::format("warn_{0} is laxer than {0} ({1} is better): expected the warning to "
                    "come before the failure",
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

std::map<Channel, double> channel_values(const TomlNode& node, std::string_view key) {
  const auto table = node.find(key);
  if (!table) return {};
  const auto values = read_channel_values(*table);
  return {values.begin(), values.end()};
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
                  const std::vector<std::string_view>& others) {
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
    if (!entry.is_table()) {
      names.insert(names.end(), others.begin(), others.end());
      node.fail_unknown(key, "metric", names);
    }
    const Channel channel = read_channel_key(node, key);
    if (std::find(outputs.begin(), outputs.end(), channel) == outputs.end()) {
      entry.fail("is no output channel: expected one of those in [recording.channels]");
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

}  // namespace

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
  campaign.acceptance =
      limits_but(node, campaign, {kDecision, kModelError, kNegligible, kNotJudged});
  campaign.acceptance_bounds.not_judged = read_not_judged(node, campaign, campaign.acceptance);
  if (const auto decision = node.find(kDecision)) {
    campaign.acceptance_bounds.decision = decision->choice<DecisionRule>(
        {{"simple", DecisionRule::simple}, {"guard_band", DecisionRule::guard_band}});
  }
  if (const auto ratio = node.find(kModelError)) {
    campaign.acceptance_bounds.model_error_to_noise = ratio->number(kSizes);
  }
  if (const auto table = node.find(kNegligible)) {
    for (const auto& [index, value] :
         read_overrides(*table, campaign.rig.plant, ParameterGroup::any))
      campaign.acceptance_bounds.negligible.emplace(index, std::abs(value));
  }
}

FitSettings read_fit(const TomlNode& node, const Campaign& campaign) {
  node.allow_only({"loss", "loss_scale", "max_iterations", "starts", "max_time", "outputs",
                   "posterior", "shooting_interval"});
  FitSettings fit;
  if (const auto loss = node.find("loss")) {
    fit.loss = loss->choice<Loss>({{"squared", Loss::squared},
                                   {"huber", Loss::huber},
                                   {"cauchy", Loss::cauchy},
                                   {"soft_l1", Loss::soft_l1}});
  }
  if (const auto scale = node.find("loss_scale")) {
    fit.loss_scale = scale->number(kSizes);
  }
  if (const auto count = node.find("max_iterations")) {
    fit.max_iterations = count->integer(1, 1'000'000);
  }
  if (const auto count = node.find("starts")) fit.starts = count->integer(1, 100'000);
  if (const auto draws = node.find("posterior"))
    fit.posterior = draws->integer(kLeastPosteriorDraws, kMostPosteriorDraws);
  if (const auto time = node.find("max_time")) fit.max_seconds = time->quantity("s", kDurations_s);
  if (const auto interval = node.find("shooting_interval")) {
    fit.shooting_interval_s = interval->quantity("s", kDurations_s);
  }
  const auto outputs = node.find("outputs");
  if (!outputs) return fit;
  std::vector<std::string> known;
  for (const Channel channel : output_channels(campaign)) known.emplace_back(info(channel).key);
  std::vector<std::pair<std::string, Channel>> choices;
  for (const std::string& key : known) choices.emplace_back(key, *channel_from_key(key));
  for (const TomlNode& item : outputs->items()) fit.outputs.push_back(item.choice(choices));
  if (fit.outputs.empty()) outputs->fail("is empty: expected at least one output channel");
  return fit;
}

ConsideredSettings read_considered(const TomlNode& node, const Campaign& campaign) {
  ConsideredSettings considered;
  if (node.is_boolean()) {
    if (node.boolean())
      node.fail("is true: expected a table of sizes, or false where the model counts as exact");
    considered.none = true;
    return considered;
  }
  const model::PlantKind plant = campaign.rig.plant;
  const auto names = effect_names(plant);
  for (const auto& [key, entry] : node.entries()) {
    const auto name = std::find_if(names.begin(), names.end(),
                                   [&key = key](const auto& each) { return each.key == key; });
    if (name == names.end()) {
      std::vector<std::string> known;
      for (const EffectName& each : names) known.push_back(each.key);
      node.fail_unknown(key, "effect", known);
    }
    const int index = model::parameter_index(plant, key);
    const ParameterSetting* setting = index < 0 ? nullptr : campaign.setting(index);
    if (setting != nullptr && (setting->fit || setting->prior))
      entry.fail("is in the model already, with an estimate or a prior: expected no size here");
    if (entry.is_boolean()) {
      if (entry.boolean()) entry.fail("is true: expected a size, or false to leave it out");
      considered.left_out.insert(key);
      continue;
    }
    const double size = entry.difference(name->unit);
    if (!(size > 0.0)) entry.fail("is not above zero: expected a plausible size, or false");
    const double of_no_parameter = name->unit == "1" ? 1.0 : name->unit == "Pa" ? 1e9 : 1e3;
    const double most = index < 0 ? of_no_parameter : spec_of(plant, index).upper;
    if (!(size <= most))
      entry.fail(
          fmt::format("is larger than {:g} {}, which such a term may be at most: expected "
                      "a plausible size",
                      most, name->unit));
    considered.sizes[key] = size;
  }
  return considered;
}

BetweenDaysSettings read_between_days(const TomlNode& node, const Campaign& campaign) {
  BetweenDaysSettings days;
  if (node.is_boolean()) {
    if (node.boolean())
      node.fail("is true: expected a table of sizes, or false where no day differs from another");
    days.none = true;
    return days;
  }
  const model::PlantKind plant = campaign.rig.plant;
  const auto names = day_quantity_names(plant);
  for (const auto& [key, entry] : node.entries()) {
    const auto name = std::find_if(names.begin(), names.end(),
                                   [&key = key](const auto& each) { return each.key == key; });
    if (name == names.end()) {
      std::vector<std::string> known;
      for (const DayQuantityName& each : names) known.push_back(each.key);
      node.fail_unknown(key, "quantity", known);
    }
    if (entry.is_boolean()) {
      if (entry.boolean())
        entry.fail("is true: expected a standard deviation, or false where it does not differ");
      days.left_out.insert(key);
      continue;
    }
    const double sd = entry.difference(name->unit);
    if (!(sd > 0.0))
      entry.fail("is not above zero: expected a standard deviation between days, or false");
    const int index = model::parameter_index(plant, key);
    const auto* setting = index < 0 ? nullptr : campaign.setting(index);
    double most = index < 0 ? kMostTriggerSd_s : spec_of(plant, index).upper;
    if (setting != nullptr && setting->value > 0.0) most = setting->value;
    if (!(sd <= most))
      entry.fail(
          fmt::format("is larger than {:g} {}, which it may be at most: expected a standard "
                      "deviation between days",
                      most, name->unit));
    days.sds[key] = sd;
  }
  return days;
}

SimulationSettings read_simulation(const TomlNode& node) {
  node.allow_only({"method", "tolerance", "max_seconds"});
  SimulationSettings simulation;
  if (const auto method = node.find("method")) {
    simulation.method = method->choice<model::Method>(
        {{"rosenbrock", model::Method::rosenbrock}, {"dopri5", model::Method::dopri5}});
  }
  if (const auto tolerance = node.find("tolerance")) {
    simulation.tolerance = tolerance->number();
    if (!(*simulation.tolerance >= 1e-13 && *simulation.tolerance <= 0.1)) {
      tolerance->fail_type("a relative tolerance from 1e-13 to 0.1");
    }
  }
  if (const auto seconds = node.find("max_seconds")) {
    simulation.max_seconds = seconds->number(kDurations_s);
  }
  return simulation;
}

SyntheticSettings read_synthetic(const TomlNode& node, model::PlantKind plant) {
  node.allow_only({"parameters", "leak_level", "repeats", "duration", "sample_rate", "noise",
                   "ar1_noise", "ar1_coefficient", "quantisation", "drift", "trigger_jitter",
                   "supply_ripple", "supply_ripple_frequency", "variation"});
  SyntheticSettings synthetic;
  if (const auto values = node.find("parameters")) {
    synthetic.parameters = read_overrides(*values, plant, ParameterGroup::any);
  }
  if (const auto levels = node.find("leak_level")) {
    synthetic.level_parameters = read_true_levels(*levels, plant);
  }
  if (const auto count = node.find("repeats")) synthetic.repeats = count->integer(1, 10'000);
  if (const auto value = node.find("duration")) {
    synthetic.duration_s = value->quantity("s", kDurations_s);
  }
  if (const auto value = node.find("sample_rate")) {
    synthetic.sample_rate_hz = value->quantity("Hz", kSampleRates_hz);
  }
  synthetic.noise_sd = channel_values(node, "noise");
  synthetic.ar1_sd = channel_values(node, "ar1_noise");
  if (const auto value = node.find("ar1_coefficient")) {
    synthetic.ar1_coefficient = value->number();
    if (!(synthetic.ar1_coefficient >= 0.0 && synthetic.ar1_coefficient < 1.0)) {
      value->fail_type("a coefficient per sample, at least 0 and below 1");
    }
  }
  synthetic.quantisation = channel_values(node, "quantisation");
  synthetic.drift = channel_values(node, "drift");
  if (const auto value = node.find("trigger_jitter")) {
    synthetic.trigger_jitter_s = value->quantity("s", kJitters_s);
  }
  if (const auto value = node.find("supply_ripple")) {
    synthetic.supply_ripple_pa = value->quantity("Pa", kDisturbances);
  }
  if (const auto value = node.find("supply_ripple_frequency")) {
    synthetic.supply_ripple_hz = value->quantity("Hz", kFrequencies_hz);
  }
  if (const auto table = node.find("variation")) {
    synthetic.variation = read_variation(*table, plant);
  }
  return synthetic;
}

}  // namespace rigcal::datasets
