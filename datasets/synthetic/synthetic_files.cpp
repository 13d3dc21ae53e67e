#include "datasets/synthetic/synthetic_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/campaign/toml/toml_writer.hpp"

namespace rigcal::datasets {
namespace {

using Json = nlohmann::ordered_json;

std::string label(std::uint64_t seed) {
  return fmt::format("# synthetic: made by rigcal synthesize, seed {}\n", seed);
}

double in_file_unit(double value_si, const UnitConversion& to_si) {
  return (value_si - to_si.offset) / to_si.scale;
}

/// A true value of one parameter, and its scope.
struct TrueValue {
  Scope scope = Scope::rig;
  std::string level;  ///< leak level or condition; empty for the rig
  double value = 0.0;
};

/// Groups the values of one parameter by a key of the conditions. Returns nullopt if two conditions
/// with the same key have different values, or if a condition has no key.
std::optional<std::map<std::string, double>> grouped(
    const Campaign& truth, int index,
    const std::function<std::optional<std::string>(const Condition&)>& key_of) {
  std::map<std::string, double> groups;
  for (const Condition& condition : truth.conditions) {
    const auto key = key_of(condition);
    if (!key) return std::nullopt;
    const double value = values_in(truth, condition).value[static_cast<std::size_t>(index)];
    if (groups.emplace(*key, value).first->second != value) return std::nullopt;
  }
  return groups;
}

/// Finds the widest scope in which a parameter has a single value. It is never wider than the scope
/// in the campaign.
std::vector<TrueValue> true_values(const Campaign& truth, int index) {
  const ParameterSetting* setting = truth.setting(index);
  const Scope declared = setting == nullptr ? Scope::rig : setting->scope;
  const auto listed = [](Scope scope, const std::map<std::string, double>& groups) {
    std::vector<TrueValue> result;
    for (const auto& [level, value] : groups) result.push_back({scope, level, value});
    return result;
  };
  if (declared == Scope::rig)
    if (const auto one = grouped(truth, index, [](const Condition&) { return std::string(); }))
      return listed(Scope::rig, *one);
  if (declared != Scope::condition)
    if (const auto levels =
            grouped(truth, index, [](const Condition& condition) { return condition.leak_level; }))
      return listed(Scope::leak_level, *levels);
  return listed(Scope::condition,
                *grouped(truth, index, [](const Condition& condition) { return condition.id; }));
}

Json parameters_json(const Campaign& truth) {
  Json list = Json::array();
  const auto table = model::parameter_table(truth.rig.plant);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const bool given = std::any_of(
        truth.conditions.begin(), truth.conditions.end(),
        [&](const Condition& condition) -> bool { return values_in(truth, condition).given[row]; });
    for (const TrueValue& each : true_values(truth, static_cast<int>(row))) {
      if (!std::isfinite(each.value)) continue;
      list.push_back({{"name", table[row].name},
                      {"symbol", table[row].symbol},
                      {"unit", table[row].unit},
                      {"scope", to_string(each.scope)},
                      {"level", each.scope == Scope::rig ? Json() : Json(each.level)},
                      {"value", each.value},
                      {"given", given}});
    }
  }
  return list;
}

Json by_channel(const std::map<Channel, double>& values) {
  Json object = Json::object();
  for (const auto& [channel, value] : values) object[std::string(info(channel).name)] = value;
  return object;
}

Json settings_json(const Campaign& truth) {
  const SyntheticSettings& settings = *truth.synthetic_settings;
  Json variation = Json::object();
  for (const auto& [index, sd] : settings.variation)
    variation[std::string(model::parameter_spec(truth.rig.plant, index).key)] = sd;
  return {{"repeats", settings.repeats},
          {"noise_sd", by_channel(settings.noise_sd)},
          {"ar1_sd", by_channel(settings.ar1_sd)},
          {"ar1_coefficient", settings.ar1_coefficient},
          {"quantisation", by_channel(settings.quantisation)},
          {"drift", by_channel(settings.drift)},
          {"trigger_jitter_s", settings.trigger_jitter_s},
          {"supply_ripple_pa", settings.supply_ripple_pa},
          {"supply_ripple_hz", settings.supply_ripple_hz},
          {"relative_variation", variation}};
}

Json fates_json(const Campaign& truth, const std::vector<std::vector<RepeatFate>>& fates) {
  Json list = Json::array();
  for (std::size_t c = 0; c < truth.conditions.size(); ++c) {
    const Condition& condition = truth.conditions[c];
    Json repeats = Json::array();
    for (const RepeatFate& fate : fates[c]) {
      Json varied = Json::object();
      for (const auto& [index, value] : fate.varied)
        varied[std::string(model::parameter_spec(truth.rig.plant, index).name)] = value;
      repeats.push_back(
          {{"file", synthetic_record_path(condition.id, static_cast<int>(repeats.size()) + 1)},
           {"late_s", fate.late_s},
           {"supply_ripple_phase_rad", fate.ripple_phase_rad},
           {"varied", varied}});
    }
    list.push_back({{"id", condition.id},
                    {"leak_level", condition.leak_level ? Json(*condition.leak_level) : Json()},
                    {"repeats", repeats}});
  }
  return list;
}

}  // namespace

std::string synthetic_record_path(const std::string& condition, int repeat) {
  return fmt::format("records/{}_r{}.csv", condition, repeat);
}

std::string synthetic_column(const Campaign& campaign, Channel channel) {
  const std::string& column = campaign.channels.at(channel).column;
  return column.empty() ? std::string(info(channel).key) : column;
}

std::string synthetic_csv(const Campaign& campaign, const Repeat& repeat, std::uint64_t seed) {
  const char separator = campaign.separator == 0 ? ',' : campaign.separator;
  std::string text = label(seed);
  const auto put_name = [&](const std::string& name) {
    if (name.find(separator) != std::string::npos)
      throw InputError(
          {campaign.file.string()},
          fmt::format("column '{}' contains the separator '{}' of the records; expected "
                      "another name or separator",
                      name, separator));
    text += name;
  };
  put_name(campaign.time_column);
  for (const auto& [channel, values] : repeat.values) {
    text.push_back(separator);
    put_name(synthetic_column(campaign, channel));
  }
  text.push_back('\n');
  for (std::size_t i = 0; i < repeat.time_s.size(); ++i) {
    text += fmt::format("{:.12g}", in_file_unit(repeat.time_s[i], campaign.time_to_s));
    for (const auto& [channel, values] : repeat.values)
      text += fmt::format("{}{:.10g}", separator,
                          in_file_unit(values[i], campaign.channels.at(channel).to_si));
    text.push_back('\n');
  }
  return text;
}

std::string synthetic_campaign_text(const Campaign& campaign, std::uint64_t seed) {
  toml::table root = parse_toml_file(campaign.file);
  root.erase("synthetic");
  root.insert("synthetic", true);
  root.insert_or_assign("name", campaign.name + " (synthetic)");
  toml::array& conditions = *root.get_as<toml::array>("condition");
  for (toml::node& node : conditions) {
    toml::table& condition = *node.as_table();
    for (const std::string_view key : {"repeats", "averaged", "repeats_averaged"})
      condition.erase(key);
    toml::array repeats;
    for (int repeat = 1; repeat <= campaign.synthetic_settings->repeats; ++repeat)
      repeats.push_back(synthetic_record_path(condition["id"].value_or(std::string()), repeat));
    condition.insert("repeats", std::move(repeats));
  }
  toml::table& channels = *root["recording"]["channels"].as_table();
  for (const Channel channel : made_channels(campaign))
    channels.get_as<toml::table>(info(channel).key)
        ->insert_or_assign("column", synthetic_column(campaign, channel));
  return label(seed) + "\n" + toml_text(root);
}

std::string truth_json(const Campaign& truth, std::uint64_t seed,
                       const std::vector<std::vector<RepeatFate>>& fates) {
  const Json document{{"schema", "rigcal.truth/1"},
                      {"synthetic", true},
                      {"name", truth.name + " (synthetic)"},
                      {"seed", seed},
                      {"parameters", parameters_json(truth)},
                      {"settings", settings_json(truth)},
                      {"conditions", fates_json(truth, fates)}};
  return document.dump(2) + "\n";
}

}  // namespace rigcal::datasets
