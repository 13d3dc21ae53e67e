#include "report/leak/read_leak_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/json/json_node.hpp"
#include "report/json/read_json.hpp"
#include "report/leak/leak_table.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

void require_complete(const diagnosis::LeakEntry& entry, const JsonNode& node) {
  if (!entry.drive.amplitude()) node.fail("an entry with 'amplitude_m' or 'amplitude_v'");
  if (entry.coefficients_ci95.size() != entry.coefficients.size())
    node["coefficients_ci95"].fail("one interval, or null, per coefficient");
}

/// Compares two values up to rounding, because writing and reading a file may change the last
/// digits.
bool alike(double a, double b) {
  constexpr double kRounding = 1e-12;
  return a == b || std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

}  // namespace

EarlierLeakTable read_leak_table(const std::filesystem::path& file, model::PlantKind plant) {
  const Json json = read_json(file, "the leak_table.json of a leak table");
  const JsonNode root(json, file.string(), "", "leak_table.json");
  if (root["schema"].string() != kLeakTableSchema)
    root["schema"].fail(fmt::format("\"{}\"", kLeakTableSchema));
  StoredLeakTable stored;
  read_into(root, stored);
  EarlierLeakTable table;
  const std::vector<JsonNode> assumptions = root["assumptions"].items();
  for (std::size_t i = 0; i < assumptions.size(); ++i) {
    if (stored.assumptions[i].key == "residual_scale") continue;  // not a parameter of the rig
    table.rig.emplace_back(parameter_row(assumptions[i]["name"], plant),
                           stored.assumptions[i].value);
  }
  const std::vector<JsonNode> entries = root["entries"].items();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    require_complete(stored.entries[i], entries[i]);
    table.targets_percent.push_back(stored.entries[i].target_percent);
  }
  table.limits = std::move(stored.entries);
  std::sort(table.targets_percent.begin(), table.targets_percent.end());
  table.targets_percent.erase(
      std::unique(table.targets_percent.begin(), table.targets_percent.end()),
      table.targets_percent.end());
  return table;
}

std::vector<std::string> rig_differences(const EarlierLeakTable& table,
                                         const datasets::Campaign& campaign,
                                         const std::vector<datasets::FittedValue>& fitted) {
  const auto parameters = model::parameter_table(campaign.rig.plant);
  auto values = model::ParameterValues::defaults(campaign.rig.plant);
  for (const datasets::ParameterSetting& setting : campaign.parameters)
    values.set(setting.index, setting.value);
  for (const datasets::FittedValue& value : fitted) {
    if (value.scope == datasets::Scope::rig) values.set(value.index, value.value);
  }
  auto of_table = model::ParameterValues::defaults(campaign.rig.plant);
  for (const auto& [index, value] : table.rig) of_table.set(index, value);
  std::vector<std::string> differences;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::ParameterSpec& spec = parameters[i];
    const datasets::ParameterSetting* setting = campaign.setting(static_cast<int>(i));
    const bool moves_oil = spec.kind != model::ParameterKind::sensor &&
                           spec.key != "leakage_coefficient" &&
                           (setting == nullptr || !setting->nuisance);
    const double here = values.value[i];
    const double there = of_table.value[i];
    if (!moves_oil || alike(here, there) || (std::isnan(here) && std::isnan(there))) continue;
    differences.push_back(fmt::format("{} is {} in the table, {} in the diagnosis", spec.key,
                                      readable(there, spec.unit, 8), readable(here, spec.unit, 8)));
  }
  return differences;
}

}  // namespace rigcal::report
