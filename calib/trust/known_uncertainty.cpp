#include "calib/trust/known_uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/problem/day_effects.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// A known value with a stated uncertainty.
struct Known {
  std::string name;
  int index = 0;    ///< row of the parameter table
  double sd = 0.0;  ///< in SI units
  bool of_sensor = false;
};

/// Adds the uncertainty of a channel's sensor as priors on its gain and offset, unless these are
/// estimated or have priors.
void add_sensor(const Problem& problem, const datasets::ChannelSetting& channel,
                std::vector<Known>& result) {
  const auto key = datasets::info(channel.channel).key;
  const auto add = [&](const char* what, double sd) {
    const int index =
        model::parameter_index(problem.campaign->rig.plant, fmt::format("{}_{}", key, what));
    const auto* setting = index < 0 ? nullptr : problem.campaign->setting(index);
    const bool elsewhere = setting != nullptr && (setting->fit || setting->prior);
    if (!(sd > 0.0) || index < 0 || elsewhere) return;
    result.push_back({certificate_name(what, key), index, sd, true});
  };
  const auto* gain = problem.campaign->setting(
      model::parameter_index(problem.campaign->rig.plant, fmt::format("{}_gain", key)));
  add("gain", channel.gain_sd * (gain != nullptr ? std::abs(gain->value) : 1.0));
  add("offset", channel.offset_sd);
}

std::vector<Known> uncertain_values(const Problem& problem) {
  std::vector<Known> result;
  for (const auto& setting : problem.campaign->parameters) {
    const auto& spec = model::parameter_spec(problem.campaign->rig.plant, setting.index);
    if (setting.prior && !setting.fit && spec.can_be_fitted)
      result.push_back({std::string(spec.name), setting.index, setting.prior->sd, false});
  }
  std::set<datasets::Channel> compared;
  for (const ProblemCondition& condition : problem.conditions)
    for (const ProblemChannel& channel : condition.channels) compared.insert(channel.channel);
  for (const datasets::Channel channel : compared)
    add_sensor(problem, problem.campaign->channels.at(channel), result);
  return result;
}

/// Returns the sensitivities to known values, multiplied by their standard deviations.
Eigen::MatrixXd known_rows(const Problem& problem, std::size_t i, std::span<const double> z,
                           const std::vector<Known>& values) {
  std::vector<int> indices;
  for (const Known& each : values) indices.push_back(each.index);
  Eigen::MatrixXd rows = known_sensitivities(problem, i, z, indices);
  if (rows.size() == 0) return rows;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const Known& each = values[p];
    // A prior applies to the value of the rig, and therefore not to conditions with a value of
    // their own. A certificate applies to the sensor, and therefore to all conditions.
    const bool own = !each.of_sensor &&
                     known_in(*problem.campaign, *problem.conditions[i].condition, each.index);
    rows.col(static_cast<Eigen::Index>(p)) *= own ? 0.0 : each.sd;
  }
  return rows;
}

}  // namespace

Eigen::MatrixXd known_sensitivities(const Problem& problem, std::size_t condition,
                                    std::span<const double> z, const std::vector<int>& indices) {
  const ProblemCondition& each = problem.conditions[condition];
  const auto run =
      model::simulate(each.rig, problem.values_at(condition, z), indices, each.inputs,
                      each.fit_times(), each.outputs, problem.derivative_options(condition));
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

std::string certificate_name(std::string_view what, std::string_view channel) {
  return fmt::format("{}_sd of {}", what, channel);
}

std::vector<std::string> uncertain_names(const Problem& problem) {
  std::vector<std::string> names;
  for (const Known& each : uncertain_values(problem)) names.push_back(each.name);
  return names;
}

Eigen::MatrixXd response_of_unknowns(const Problem& problem, const std::vector<ConditionRows>& rows,
                                     const ArrowRoot& root, Eigen::Index columns, int threads,
                                     const std::function<Eigen::MatrixXd(std::size_t)>& known) {
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(root.unknowns(), columns);
  if (columns == 0) return response;
  std::vector<Eigen::MatrixXd> parts(problem.conditions.size());
  parallel_for(parts.size(), threads, [&](std::size_t i) {
    const Eigen::MatrixXd changes = known(i);
    if (changes.size() == 0) return;
    parts[i] =
        root.rows(problem.map.acting(i), i).transpose() * (rows[i].jacobian.transpose() * changes);
  });
  const Eigen::Index shared = root.shared().cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(shared, columns);
  for (const Eigen::MatrixXd& part : parts) {
    if (part.size() > 0) sum += part.bottomRows(shared);
  }
  for (Eigen::Index j = 0; j < root.unknowns(); ++j) {
    const auto i = static_cast<std::size_t>(std::max(0, root.condition_of(j)));
    const Eigen::VectorXd c = root.row(j, i);
    response.row(j) = -(c.tail(shared).transpose() * sum);
    if (root.condition_of(j) >= 0 && parts[i].size() > 0) {
      const Eigen::Index own = root.own_directions(i);
      response.row(j) -= c.head(own).transpose() * parts[i].topRows(own);
    }
  }
  return response;
}

KnownUncertainty known_uncertainty(const Problem& problem, std::span<const double> z,
                                   const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                                   int threads) {
  KnownUncertainty result;
  const std::vector<Known> values = uncertain_values(problem);
  result.names = uncertain_names(problem);
  result.response =
      response_of_unknowns(problem, rows, root, static_cast<Eigen::Index>(values.size()), threads,
                           [&](std::size_t i) { return known_rows(problem, i, z, values); });
  return result;
}

Eigen::VectorXd day_errors(const Problem& problem, std::span<const double> z,
                           const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                           int threads) {
  if (problem.conditions.empty()) return Eigen::VectorXd::Zero(root.unknowns());
  std::vector<std::string> days;
  std::vector<Eigen::Index> day_of;  // for each condition, the index of its day
  for (const ProblemCondition& each : problem.conditions) {
    const std::string day = each.condition->date.value_or("");
    const auto found = std::find(days.begin(), days.end(), day);
    day_of.push_back(found - days.begin());
    if (found == days.end()) days.push_back(day);
  }
  const std::vector<DayQuantity> quantities =
      day_quantities(*problem.campaign, problem.values_at(0, z), problem.shortest_interval_s());
  const std::vector<int> indices = further_rows(quantities, {});
  const auto count = static_cast<Eigen::Index>(quantities.size());
  const Eigen::Index columns = count * static_cast<Eigen::Index>(days.size());
  const auto changes = [&](std::size_t i) -> Eigen::MatrixXd {
    const ProblemCondition& data = problem.conditions[i];
    const auto run = model::simulate(data.rig, problem.values_at(i, z), indices, data.inputs,
                                     data.fit_times(), data.outputs, problem.derivative_options(i));
    if (!run.ok()) return {};
    const auto samples = static_cast<Eigen::Index>(data.rows.size());
    const std::vector<Eigen::Index> counted(data.rows.begin(), data.rows.end());
    const auto channels = static_cast<Eigen::Index>(data.channels.size());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(samples * channels, columns);
    for (Eigen::Index k = 0; k < channels; ++k)
      result.block(k * samples, day_of[i] * count, samples, count) =
          day_changes(data, run, k, indices, data.fit_times(), quantities)(counted, Eigen::all) /
          data.channels[static_cast<std::size_t>(k)].sd;
    return result;
  };
  return response_of_unknowns(problem, rows, root, columns, threads, changes).rowwise().norm();
}

}  // namespace rigcal::calib
