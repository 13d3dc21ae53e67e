#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

bool is_date(std::string_view key) {
  return key == "issued" || key == "calibrated" || key == "due";
}

template <std::size_t count>
ReportSettings::Fields read_fields(const TomlNode& node,
                                   const std::array<ReportField, count>& known) {
  ReportSettings::Fields fields;
  for (const ReportField& field : known) {
    if (const auto value = node.find(field.key))
      fields.emplace_back(field.key, is_date(field.key) ? value->date() : value->name());
  }
  return fields;
}

template <std::size_t count>
std::vector<std::string> keys_of(const std::array<ReportField, count>& known) {
  std::vector<std::string> keys;
  for (const ReportField& field : known) keys.emplace_back(field.key);
  return keys;
}

}  // namespace

ReportSettings read_report(const TomlNode& node) {
  std::vector<std::string> keys = keys_of(kReportFields);
  keys.emplace_back("sensor");
  node.allow_only(keys);
  ReportSettings settings;
  settings.fields = read_fields(node, kReportFields);
  const auto sensors = node.find("sensor");
  if (!sensors) return settings;
  if (!sensors->is_array()) sensors->fail_type("[[report.sensor]], in double brackets");
  for (const TomlNode& sensor : sensors->items()) {
    sensor.allow_only(keys_of(kSensorFields));
    sensor.require("channel", "the channel that the sensor is of, such as \"position\"");
    settings.sensors.push_back(read_fields(sensor, kSensorFields));
  }
  return settings;
}

}  // namespace rigcal::datasets
