#include "report/store/plan.hpp"

#include <fmt/format.h>

namespace rigcal::report {

std::string StoredPlannedParameter::label() const {
  return level ? fmt::format("{} ({})", name, *level) : name;
}

std::string StoredDesignedParameter::label() const {
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

StoredDesign stored(const datasets::Campaign& campaign, const calib::Design& design) {
  const auto table = model::parameter_table(campaign.rig.plant);
  const datasets::DesignSettings& settings = *campaign.design;
  const datasets::ChannelInfo& channel = datasets::info(datasets::drive_channel(campaign));
  StoredDesign file;
  file.status = design.stopped ? "stopped" : "done";
  file.family = design.family;
  file.criterion = settings.criterion;
  file.channel = channel.key;
  file.unit = channel.unit;
  file.amplitude = design.amplitude;
  file.duration_s = settings.duration_s;
  file.sample_rate_hz = settings.sample_rate_hz;
  file.repeats = settings.repeats;
  file.seed = settings.seed;
  if (settings.like) file.leak_level = campaign.find(*settings.like)->leak_level;
  for (const auto& [measured, sd] : design.noise_sd)
    file.noise_sd.emplace_back(datasets::info(measured).name, sd);
  for (const calib::DesignedParameter& each : design.parameters) {
    const calib::FittedParameter& p = each.parameter;
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(p.index)];
    file.parameters.push_back({std::string(spec.name), std::string(spec.unit), p.scope,
                               unless_empty(p.level), each.named, p.value, each.sd, each.sd_own});
  }
  for (const calib::LimitUse& use : design.limits)
    file.limits.push_back(
        {use.key, use.words, use.unit, use.limit, use.reached, 100.0 * use.share});
  for (const calib::DrivePart& part : design.parts)
    file.drive.push_back({part.name, part.unit, part.value});
  for (const calib::FamilyTrial& trial : design.trials)
    file.families.push_back({trial.family, trial.evaluations, trial.found, trial.sd});
  file.own_signals = design.own_conditions;
  file.own_signals_duration_s = design.own_duration_s;
  file.messages = design.messages;
  return file;
}

Table response_of(const datasets::Campaign& campaign, const calib::Design& design) {
  Table table;
  const auto add = [&](std::string_view name, std::vector<double> values) {
    table.names.emplace_back(name);
    table.columns.push_back(std::move(values));
  };
  add("time_s", design.time_s);
  add(datasets::info(datasets::drive_channel(campaign)).name, design.drive);
  const auto outputs = calib::limited_outputs();
  const bool commanded = datasets::drive_channel(campaign) == datasets::Channel::command;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (commanded && outputs[k] == model::Output::command) continue;  // it is the drive
    const auto column = design.response.col(static_cast<Eigen::Index>(k));
    add(model::output_name(outputs[k]), {column.begin(), column.end()});
  }
  return table;
}

}  // namespace rigcal::report
