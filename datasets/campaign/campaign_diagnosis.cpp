#include <fmt/format.h>

#include <algorithm>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

std::vector<std::string> bounded_classes() {
  std::vector<std::string> bounded;
  for (std::size_t i = 0; i < DiagnosisSettings().limits.size(); ++i)
    bounded.emplace_back(to_string(kLeakClasses[i]));
  return bounded;
}

void read_class_limits(const TomlNode& node, DiagnosisSettings& settings) {
  const std::vector<std::string> bounded = bounded_classes();
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
          fmt::format("{} ends at {} % by default, which is not above {} %, where it begins: "
                      "expected a limit for it too",
                      bounded[i], 100.0 * settings.limits[i], 100.0 * lower));
    }
    lower = settings.limits[i];
  }
}

}  // namespace

const char* leak_parameter(LeakLaw law) {
  return law == LeakLaw::laminar ? "laminar_leakage" : "leakage_coefficient";
}

LeakClass class_of(const DiagnosisSettings& settings, double share) {
  const auto above = std::upper_bound(settings.limits.begin(), settings.limits.end(), share);
  return kLeakClasses[static_cast<std::size_t>(above - settings.limits.begin())];
}

const KeyTable<DiagnosisSettings>& diagnosis_keys() {
  using Row = KeyRow<DiagnosisSettings>;
  const NumberLimits probability{{0.0, 1.0}, "a probability between 0 and 1", true, true};
  KeyForm limits = plain_form(KeyForm::Kind::table);
  const DiagnosisSettings usual;
  for (std::size_t i = 0; i < usual.limits.size(); ++i)
    limits.keys.push_back({bounded_classes()[i], number_form({-kSizes.upper, kSizes.upper}),
                           "Upper limit of this class, in percent of the servo flow",
                           fmt::format("{:g}", 100.0 * usual.limits[i])});
  static const KeyTable<DiagnosisSettings> keys({
      Row::word<LeakLaw>(
          "leak_law", &DiagnosisSettings::leak_law,
          {.doc = "Law of the leak that is fitted to each record: `orifice` estimates "
                  "`leakage_coefficient`, `laminar` estimates `laminar_leakage`"}),
      Row::custom("limits_percent", limits, read_class_limits,
                  {.doc = "Upper limit of each class as the share of the servo flow that leaks, in "
                          "percent; what is above the last is supercritical",
                   .otherwise = "`{ normal = 1, slight = 10, medium = 20, critical = 30 }`",
                   .example = "{ slight = 12.0 }"}),
      Row::number("least_probability", &DiagnosisSettings::least_probability, probability,
                  {.doc = "A record is undecided if no class is at least this probable"}),
      Row::number("false_alarms", &DiagnosisSettings::false_alarms, probability,
                  {.doc = "Accepted probability that a healthy record is classed as leaking"}),
      Row::number("detection", &DiagnosisSettings::detection, probability,
                  {.doc = "Fraction of leaks of the smallest detectable size that are found"}),
      Row::text("duty", &DiagnosisSettings::duty, "the id of a condition",
                {.doc = "Id of the condition whose signal defines the share stated for a machine",
                 .otherwise = "the slowest generated sine; among these, the largest",
                 .example = "\"sine\""}),
      Row::custom("level_class", entries_form(word_form(words_of(enumerator_words<LeakClass>()))),
                  [](const TomlNode& node, DiagnosisSettings& settings) {
                    for (const auto& [level, entry] : node.entries())
                      settings.level_class[level] = entry.choice(enumerator_words<LeakClass>());
                  },
                  {.doc = "Leak levels whose class is known, `{ \"0 %\" = \"normal\" }`: the "
                          "diagnosis is checked against them, and they define the healthy records",
                   .otherwise = "`{}`",
                   .example = "{ \"0 %\" = \"normal\" }"}),
  });
  return keys;
}

DiagnosisSettings read_diagnosis(const TomlNode& node) {
  DiagnosisSettings settings;
  diagnosis_keys().read(node, settings);
  return settings;
}

void check_duty(const TomlNode& node, const Campaign& campaign) {
  const auto duty = node.find("duty");
  if (duty && campaign.find(campaign.diagnosis.duty) == nullptr)
    duty->fail_type("the id of a condition");
}

}  // namespace rigcal::datasets
