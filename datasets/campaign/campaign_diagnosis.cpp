#include <fmt/format.h>

#include <algorithm>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

std::vector<std::pair<std::string, LeakClass>> class_choices() {
  std::vector<std::pair<std::string, LeakClass>> choices;
  for (const LeakClass each : kLeakClasses) choices.emplace_back(to_string(each), each);
  return choices;
}

void read_limits(const TomlNode& node, DiagnosisSettings& settings) {
  std::vector<std::string> bounded;
  for (std::size_t i = 0; i < settings.limits.size(); ++i)
    bounded.emplace_back(to_string(kLeakClasses[i]));
  node.allow_only(bounded);
  double lower = 0.0;
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    if (const auto entry = node.find(bounded[i])) {
      settings.limits[i] = entry->number({-kSizes.upper, kSizes.upper}) / 100.0;
      if (!(settings.limits[i] > lower)) {
        entry->fail(fmt::format("{} % is not above {} %, where the class begins", entry->number(),
                                100.0 * lower));
      }
    } else if (!(settings.limits[i] > lower)) {
      node.fail(
          fmt::format("{} ends at {} % unless given, which is not above {} %, where it "
                      "begins: expected its limit too",
                      bounded[i], 100.0 * settings.limits[i], 100.0 * lower));
    }
    lower = settings.limits[i];
  }
}

void read_probability(const TomlNode& node, std::string_view key, double& value) {
  const auto entry = node.find(key);
  if (!entry) return;
  value = entry->number();
  if (!(value > 0.0 && value < 1.0)) entry->fail_type("a probability between 0 and 1");
}

}  // namespace

std::string_view to_string(LeakClass leak_class) {
  switch (leak_class) {
    case LeakClass::normal:
      return "normal";
    case LeakClass::slight:
      return "slight";
    case LeakClass::medium:
      return "medium";
    case LeakClass::critical:
      return "critical";
    case LeakClass::supercritical:
      return "supercritical";
  }
  return "";
}

LeakClass class_of(const DiagnosisSettings& settings, double share) {
  const auto above = std::upper_bound(settings.limits.begin(), settings.limits.end(), share);
  return kLeakClasses[static_cast<std::size_t>(above - settings.limits.begin())];
}

DiagnosisSettings read_diagnosis(const TomlNode& node) {
  node.allow_only(
      {"limits_percent", "least_probability", "false_alarms", "detection", "duty", "level_class"});
  DiagnosisSettings settings;
  if (const auto limits = node.find("limits_percent")) read_limits(*limits, settings);
  read_probability(node, "least_probability", settings.least_probability);
  read_probability(node, "false_alarms", settings.false_alarms);
  read_probability(node, "detection", settings.detection);
  if (const auto duty = node.find("duty")) settings.duty = duty->name("the id of a condition");
  if (const auto levels = node.find("level_class")) {
    for (const auto& [level, entry] : levels->entries())
      settings.level_class[level] = entry.choice(class_choices());
  }
  return settings;
}

void check_duty(const TomlNode& node, const Campaign& campaign) {
  const auto duty = node.find("duty");
  if (duty && campaign.find(campaign.diagnosis.duty) == nullptr)
    duty->fail_type("the id of a condition");
}

}  // namespace rigcal::datasets
