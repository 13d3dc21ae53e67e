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

std::string StoredPlannedParameter::label() const {
  return level ? fmt::format("{} ({})", name, *level) : name;
}

StoredPlan stored(const datasets::Campaign& campaign, const calib::Plan& plan,
                  const Provenance& provenance) {
  const auto table = model::parameter_table(campaign.rig.plant);
  StoredPlan file;
  file.campaign = campaign.name;
  for (std::size_t j = 0; j < plan.parameters.size(); ++j) {
    const calib::FittedParameter& p = plan.parameters[j];
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(p.index)];
    file.parameters.push_back({std::string(spec.name), std::string(spec.unit), p.scope,
                               unless_empty(p.level), p.nuisance, p.value, plan.recorded[j],
                               plan.all[j], unless_empty(plan.remedies[j])});
  }
  for (const calib::PlannedRecord& record : plan.records) {
    file.records.push_back({record.condition, record.recorded, unless_empty(record.problem),
                            record.alone, record.without});
  }
  file.messages = plan.messages;
  file.provenance = stored(provenance);
  return file;
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
