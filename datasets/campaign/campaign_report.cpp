#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "datasets/campaign/campaign_sections.hpp"
#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {
namespace {

/// Keys that are meaningful only together with another one.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kReportNeeds{
    {{"revision", "number"}, {"replaces", "number"}, {"approver_function", "approver"}}};

template <std::size_t count>
ReportSettings::Fields read_fields(const TomlNode& node,
                                   const std::array<ReportField, count>& known) {
  ReportSettings::Fields fields;
  for (const ReportField& field : known) {
    if (const auto value = node.find(field.key))
      fields.emplace_back(field.key, field.is_date ? value->date() : value->name());
  }
  return fields;
}

template <std::size_t count>
std::vector<CampaignKey> keys_of(const std::array<ReportField, count>& known) {
  std::vector<CampaignKey> keys;
  for (const ReportField& field : known)
    keys.push_back({std::string(field.key),
                    plain_form(field.is_date ? KeyForm::Kind::date : KeyForm::Kind::text),
                    std::string(field.doc),
                    {},
                    "none"});
  return keys;
}

const std::vector<CampaignKey>& sensor_keys() {
  static const std::vector<CampaignKey> keys = [] {
    std::vector<CampaignKey> rows = keys_of(kSensorFields);
    rows.front().needed = true;  // `channel`
    return rows;
  }();
  return keys;
}

/// Stated uncertainty of a sensor, with its place in the file.
struct Statement {
  double sd = 0.0;
  TomlNode node;
};

/// Merges what sensors and [recording.channels] state about the same uncertainty of a channel.
class Statements {
 public:
  explicit Statements(const TomlNode& root) : root_(root) {}

  /// @param key  "gain_sd" or "offset_sd"
  /// @throws InputError  if two statements differ
  void merge(Channel channel, std::string_view key, Statement stated, double& into) {
    constexpr double kSame = 1e-6;
    std::optional<Statement>& other = known_[{channel, std::string(key)}];
    if (!other) {
      if (const auto own = own_of(channel, key)) other = Statement{into, *own};
    }
    if (other && std::abs(other->sd - stated.sd) > kSame * std::max(other->sd, stated.sd)) {
      stated.node.fail(
          fmt::format("is a standard uncertainty of {:.6g}, but '{}' at {} states {:.6g}: expected "
                      "the same value, or only one of them",
                      stated.sd, other->node.path(), other->node.where().text(), other->sd));
    }
    if (!other) other = stated;
    into = other->sd;
  }

 private:
  std::optional<TomlNode> own_of(Channel channel, std::string_view key) const {
    const auto recording = root_.find("recording");
    const auto channels = recording ? recording->find("channels") : std::nullopt;
    const auto own = channels ? channels->find(info(channel).key) : std::nullopt;
    return own ? own->find(key) : std::nullopt;
  }

  TomlNode root_;
  std::map<std::pair<Channel, std::string>, std::optional<Statement>> known_;
};

}  // namespace

void apply_sensors(const TomlNode& root, Campaign& campaign) {
  const auto report = root.find("report");
  const auto sensors = report ? report->find("sensor") : std::nullopt;
  if (!sensors) return;
  Statements statements(root);
  for (const TomlNode& sensor : sensors->items()) {
    const auto text = sensor.find("uncertainty");
    const auto channel = channel_from_key(sensor.require("channel", "a channel").name());
    if (!text || !channel) continue;
    const auto setting = campaign.channels.find(*channel);
    if (setting == campaign.channels.end() || setting->second.in_counts) continue;
    const StatedUncertainty stated = stated_uncertainty(text->name(), info(*channel).unit);
    if (stated.gain_sd && *stated.gain_sd >= 1.0)
      text->fail_type("an uncertainty of the gain below 100 % (k = 1)");
    if (stated.offset_sd && *stated.offset_sd > kDisturbances.upper)
      text->fail_type(fmt::format("an uncertainty of at most {:g} {} (k = 1)", kDisturbances.upper,
                                  info(*channel).unit));
    if (stated.gain_sd)
      statements.merge(*channel, "gain_sd", {*stated.gain_sd, *text}, setting->second.gain_sd);
    if (stated.offset_sd)
      statements.merge(*channel, "offset_sd", {*stated.offset_sd, *text},
                       setting->second.offset_sd);
  }
}

const std::vector<CampaignKey>& report_keys() {
  static const std::vector<CampaignKey> keys = [] {
    std::vector<CampaignKey> rows = keys_of(kReportFields);
    rows.push_back({"sensor",
                    list_form(table_form(sensor_keys()), "tables", 0),
                    "The sensors of the test, each a table `[[report.sensor]]`",
                    {},
                    "none"});
    return rows;
  }();
  return keys;
}

ReportSettings read_report(const TomlNode& node) {
  node.allow_only(names_of(report_keys()));
  for (const auto& [key, needed] : kReportNeeds) {
    const auto given = node.find(key);
    if (given && !node.find(needed)) given->fail(fmt::format("needs '{}' in [report]", needed));
  }
  ReportSettings settings;
  settings.fields = read_fields(node, kReportFields);
  const auto sensors = node.find("sensor");
  if (!sensors) return settings;
  if (!sensors->is_array()) sensors->fail_type("[[report.sensor]], in double brackets");
  for (const TomlNode& sensor : sensors->items()) {
    sensor.allow_only(names_of(sensor_keys()));
    sensor.require("channel", "the channel that the sensor measures, such as \"position\"");
    settings.sensors.push_back(read_fields(sensor, kSensorFields));
  }
  return settings;
}

}  // namespace rigcal::datasets
