#include "calib/trust/known_uncertainty.hpp"

#include <algorithm>

#include "calib/problem/evaluation.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

std::vector<datasets::ParameterSetting> uncertain_settings(const Problem& problem) {
  const auto table = model::parameter_table(problem.campaign->rig.plant);
  std::vector<datasets::ParameterSetting> result;
  for (const auto& setting : problem.campaign->parameters) {
    const bool usable = table[static_cast<std::size_t>(setting.index)].can_be_fitted;
    if (setting.prior && !setting.fit && usable) result.push_back(setting);
  }
  return result;
}

/// Sensitivities to known values times their standard deviations.
Eigen::MatrixXd known_rows(const Problem& problem, std::size_t i, std::span<const double> z,
                           const std::vector<datasets::ParameterSetting>& settings) {
  std::vector<int> indices;
  for (const auto& setting : settings) indices.push_back(setting.index);
  Eigen::MatrixXd rows = known_sensitivities(problem, i, z, indices);
  if (rows.size() == 0) return rows;
  for (std::size_t p = 0; p < settings.size(); ++p) {
    const bool own =
        known_in(*problem.campaign, *problem.conditions[i].condition, settings[p].index);
    rows.col(static_cast<Eigen::Index>(p)) *= own ? 0.0 : settings[p].prior->sd;
  }
  return rows;
}

}  // namespace

Eigen::MatrixXd known_sensitivities(const Problem& problem, std::size_t condition,
                                    std::span<const double> z, const std::vector<int>& indices) {
  const ProblemCondition& each = problem.conditions[condition];
  const auto run = model::simulate(each.rig, problem.values_at(condition, z), indices, each.inputs,
                                   each.fit_times(), each.outputs, problem.simulation_options());
  if (!run.ok()) return {};
  const auto samples = static_cast<Eigen::Index>(each.rows.size());
  const auto channels = static_cast<Eigen::Index>(each.channels.size());
  Eigen::MatrixXd rows(samples * channels, static_cast<Eigen::Index>(indices.size()));
  for (Eigen::Index k = 0; k < channels; ++k) {
    const auto channel = static_cast<std::size_t>(k);
    for (Eigen::Index t = 0; t < samples; ++t) {
      const auto sample = static_cast<Eigen::Index>(each.rows[static_cast<std::size_t>(t)]);
      rows.row(k * samples + t) =
          run.sensitivities[channel].row(sample) / each.channels[channel].sd;
    }
  }
  return rows;
}

KnownUncertainty known_uncertainty(const Problem& problem, std::span<const double> z,
                                   const std::vector<ConditionRows>& rows,
                                   const Eigen::MatrixXd& root, int threads) {
  KnownUncertainty result;
  const auto settings = uncertain_settings(problem);
  const auto table = model::parameter_table(problem.campaign->rig.plant);
  for (const auto& setting : settings)
    result.names.emplace_back(table[static_cast<std::size_t>(setting.index)].name);
  const auto knowns = static_cast<Eigen::Index>(settings.size());
  result.response = Eigen::MatrixXd::Zero(root.rows(), knowns);
  if (settings.empty()) return result;
  std::vector<Eigen::MatrixXd> parts(problem.conditions.size());
  parallel_for(parts.size(), threads, [&](std::size_t i) {
    const Eigen::MatrixXd known = known_rows(problem, i, z, settings);
    if (known.size() == 0) return;
    parts[i] = root(problem.map.acting(i), Eigen::all).transpose() *
               (rows[i].jacobian.transpose() * known);
  });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(root.cols(), knowns);
  for (const Eigen::MatrixXd& part : parts) {
    if (part.size() > 0) sum += part;
  }
  result.response = -(root * sum);
  return result;
}

}  // namespace rigcal::calib
