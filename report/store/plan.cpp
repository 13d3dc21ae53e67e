#include "report/store/plan.hpp"

#include <fmt/format.h>

namespace rigcal::report {
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

}  // namespace rigcal::report
