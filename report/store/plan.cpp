#include "report/store/plan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

std::string planned_name(const datasets::Campaign& campaign,
                         const calib::FittedParameter& parameter) {
  const auto table = model::parameter_table(campaign.rig.plant);
  const auto key = table[static_cast<std::size_t>(parameter.index)].key;
  return parameter.level.empty() ? std::string(key) : fmt::format("{} ({})", key, parameter.level);
}

Json deviations(const std::vector<std::optional<double>>& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(number(value));
  return list;
}

std::string percent_or_dash(const std::optional<double>& sd, double value) {
  if (!sd || value == 0.0) return "-";
  return fmt::format("{:.3g}", 100.0 * *sd / std::abs(value));
}

void add_plan_row(TextTable& table, const std::string& label, const calib::Plan& plan,
                  const std::vector<std::optional<double>>& sd) {
  std::vector<std::string> row{label};
  for (std::size_t j = 0; j < plan.parameters.size(); ++j)
    row.push_back(sd.empty() ? "-" : percent_or_dash(sd[j], plan.parameters[j].value));
  table.add(std::move(row));
}

}  // namespace

Json plan_json(const datasets::Campaign& campaign, const calib::Plan& plan,
               const Provenance& provenance) {
  const auto table = model::parameter_table(campaign.rig.plant);
  Json json;
  json["schema"] = "rigcal.plan/1";
  json["campaign"] = campaign.name;
  json["parameters"] = Json::array();
  for (std::size_t j = 0; j < plan.parameters.size(); ++j) {
    const calib::FittedParameter& p = plan.parameters[j];
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(p.index)];
    Json entry;
    entry["name"] = std::string(spec.name);
    entry["unit"] = std::string(spec.unit);
    entry["scope"] = std::string(to_string(p.scope));
    entry["level"] = p.level.empty() ? Json(nullptr) : Json(p.level);
    entry["nuisance"] = p.nuisance;
    entry["value"] = number(p.value);
    entry["sd_recorded"] = number(plan.recorded[j]);
    entry["sd_all"] = number(plan.all[j]);
    entry["remedy"] = plan.remedies[j].empty() ? Json(nullptr) : Json(plan.remedies[j]);
    json["parameters"].push_back(std::move(entry));
  }
  json["records"] = Json::array();
  for (const calib::PlannedRecord& record : plan.records) {
    Json entry;
    entry["condition"] = record.condition;
    entry["recorded"] = record.recorded;
    entry["problem"] = record.problem.empty() ? Json(nullptr) : Json(record.problem);
    entry["sd_alone"] = deviations(record.alone);
    entry["sd_without"] = deviations(record.without);
    json["records"].push_back(std::move(entry));
  }
  json["messages"] = plan.messages;
  json["provenance"] = json_of(stored(provenance));
  return json;
}

std::string plan_text(const datasets::Campaign& campaign, const calib::Plan& plan,
                      std::size_t columns_of_terminal) {
  std::vector<TextTable::Column> columns{{"standard deviation in % from"}};
  for (const auto& parameter : plan.parameters)
    columns.push_back({planned_name(campaign, parameter), TextTable::Align::right});
  TextTable table(columns);
  for (const calib::PlannedRecord& record : plan.records) {
    add_plan_row(table, record.condition + (record.recorded ? " alone" : " alone (planned)"), plan,
                 record.alone);
  }
  add_plan_row(table, "all that are recorded", plan, plan.recorded);
  add_plan_row(table, "all", plan, plan.all);
  std::string text = table.text(columns_of_terminal) + "\n";
  text += "at best: white noise, the model right (Cramer-Rao); -: not determined\n";
  for (const calib::PlannedRecord& record : plan.records) {
    if (!record.problem.empty()) text += record.condition + ": " + record.problem + "\n";
  }
  for (const std::string& message : plan.messages) text += message + "\n";
  return text;
}

}  // namespace rigcal::report
