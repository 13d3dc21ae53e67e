#include "report/store/plan.hpp"

#include <fmt/format.h>

namespace rigcal::report {

StoredPlan stored(const datasets::Campaign& campaign, const calib::Plan& plan,
                  const Provenance& provenance) {
  StoredPlan file;
  static_cast<calib::Plan&>(file) = plan;
  file.campaign = campaign.name;
  file.provenance = stored(provenance);
  return file;
}

StoredDesign stored(const datasets::Campaign& campaign, const calib::Design& design) {
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
  file.parameters = design.parameters;
  for (const calib::LimitUse& use : design.limits)
    file.limits.push_back(
        {use.key, use.words, use.unit, use.limit, use.reached, 100.0 * use.share});
  file.drive = design.parts;
  file.families = design.trials;
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
