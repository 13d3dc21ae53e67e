#include "calib/problem/repeat_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {
namespace {

using datasets::Channel;
using Eigen::Index;

/// Returns the recorded channels that drive the simulation of a condition and differ between
/// repeats.
std::vector<Channel> differing_inputs(const Problem& problem, const ProblemCondition& condition) {
  std::vector<Channel> result;
  for (const auto& [channel, series] : condition.record->channels) {
    const auto setting = problem.campaign->channels.find(channel);
    if (setting == problem.campaign->channels.end() ||
        setting->second.role != datasets::ChannelRole::input)
      continue;
    if (is_drive(channel) && condition.condition->waveform != datasets::Waveform::recorded)
      continue;
    const bool differs =
        std::any_of(series.deviations.begin(), series.deviations.end(), [](const auto& each) {
          return std::any_of(each.begin(), each.end(), [](double x) { return x != 0.0; });
        });
    if (differs) result.push_back(channel);
  }
  return result;
}

/// Returns the record with the inputs of one repeat, or with the mean input where the repeat has no
/// sample.
datasets::Record with_inputs_of(const datasets::Record& record, const std::vector<Channel>& inputs,
                                std::size_t repeat) {
  datasets::Record result;
  result.condition = record.condition;
  result.time_s = record.time_s;
  for (const auto& [channel, series] : record.channels) {
    std::vector<double>& mean = result.channels[channel].mean;
    mean = series.mean;
    if (std::find(inputs.begin(), inputs.end(), channel) == inputs.end()) continue;
    if (repeat >= series.deviations.size()) continue;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double deviation = series.deviations[repeat][i];
      if (std::isfinite(deviation)) mean[i] += deviation;
    }
  }
  return result;
}

}  // namespace

Eigen::MatrixXd explained_by_inputs(const Problem& problem, std::size_t condition,
                                    std::span<const double> z) {
  const ProblemCondition& each = problem.conditions[condition];
  const std::vector<Channel> inputs = differing_inputs(problem, each);
  if (inputs.empty()) return {};
  const auto repeats =
      static_cast<Index>(each.record->channels.at(each.channels.front().channel).deviations.size());
  const auto samples = static_cast<Index>(each.rows.size());
  const auto values = problem.values_at(condition, z);
  const auto options = simulation_options(problem, condition, problem.tolerance, nullptr);
  const auto simulate = [&](const model::SimulationInputs& signals) {
    return model::simulate(each.rig, values, {}, signals, each.fit_times(), each.outputs, options);
  };
  const auto mean = simulate(each.inputs);
  if (!mean.ok()) return {};
  Eigen::MatrixXd result(samples * static_cast<Index>(each.channels.size()), repeats);
  for (Index r = 0; r < repeats; ++r) {
    const auto record = with_inputs_of(*each.record, inputs, static_cast<std::size_t>(r));
    const auto run =
        simulate(datasets::inputs_of(*problem.campaign, *each.condition, values, &record));
    if (!run.ok()) return {};
    for (std::size_t k = 0; k < each.channels.size(); ++k) {
      const auto column = static_cast<Index>(k);
      for (Index t = 0; t < samples; ++t) {
        const auto row = static_cast<Index>(each.rows[static_cast<std::size_t>(t)]);
        result(column * samples + t, r) =
            (run.outputs(row, column) - mean.outputs(row, column)) / each.channels[k].sd;
      }
    }
  }
  return result;
}

}  // namespace rigcal::calib
