#include "calib/trust/planned_record.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/synthetic/model_output.hpp"

namespace rigcal::calib {

bool is_planned_with(const datasets::Condition& condition) {
  return condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
}

std::vector<datasets::Channel> compared_channels(const datasets::Campaign& campaign) {
  std::vector<datasets::Channel> channels;
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.role == datasets::ChannelRole::output && datasets::info(channel).is_output)
      channels.push_back(channel);
  }
  return channels;
}

double planned_sd(const datasets::Campaign& campaign, const datasets::Condition& condition,
                  datasets::Channel channel, const std::vector<datasets::Record>& records) {
  const auto of_mean = [&](double of_one, double otherwise) {
    const auto& repeats = condition.planned_repeats;
    return repeats ? of_one / std::sqrt(static_cast<double>(*repeats)) : otherwise;
  };
  const auto setting = campaign.channels.find(channel);
  if (const auto& sd = setting->second.sd) return of_mean(*sd, *sd);
  if (campaign.synthetic_settings) {
    const auto& synthetic = *campaign.synthetic_settings;
    const auto noise = synthetic.noise_sd.find(channel);
    if (noise != synthetic.noise_sd.end())
      return of_mean(noise->second, noise->second / std::sqrt(synthetic.repeats));
  }
  for (const datasets::Record& record : records) {
    const auto series = record.channels.find(channel);
    if (series == record.channels.end() || !(series->second.sd_of_mean > 0.0)) continue;
    const double sd = series->second.sd_of_mean;
    return of_mean(sd * std::sqrt(static_cast<double>(record.repeats)), sd);
  }
  throw InputError(condition.where,
                   fmt::format("condition \"{}\": the noise of channel {} is unknown, so the "
                               "information of the planned record is, too: expected `sd`",
                               condition.id, datasets::info(channel).key));
}

datasets::Record planned_record(const datasets::Campaign& campaign,
                                const datasets::Condition& condition,
                                const std::function<double(datasets::Channel)>& sd) {
  datasets::Record record;
  record.condition = condition.id;
  record.time_s = datasets::sample_times(condition, nullptr);
  const std::vector<datasets::Channel> channels = compared_channels(campaign);
  std::vector<model::Output> outputs;
  for (const datasets::Channel channel : channels)
    outputs.push_back(datasets::model_output(channel).value());
  const auto values = datasets::values_in(campaign, condition);
  model::Rig rig = campaign.rig;
  rig.initial = model::InitialState::rest;
  model::SimulationOptions options;
  options.method = campaign.simulation.method;
  const auto run =
      model::simulate(rig, values, {}, datasets::inputs_of(campaign, condition, values, nullptr),
                      record.time_s, outputs, options);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    datasets::Series series;
    if (run.ok()) {
      const auto column = run.outputs.col(static_cast<Eigen::Index>(k));
      series.mean.assign(column.begin(), column.end());
    } else {
      series.mean.assign(record.time_s.size(), 0.0);
    }
    series.sd_of_mean = sd(channels[k]);
    record.channels[channels[k]] = series;
  }
  return record;
}

}  // namespace rigcal::calib
