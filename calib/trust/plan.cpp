#include "calib/trust/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/problem/r_factor.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/trust/information.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "calib/trust/symmetry.hpp"
#include "datasets/synthetic/model_output.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::Record;

bool takes_part(const Condition& condition) {
  return condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
}

/// Noise of the mean of as many repeats as the condition plans; without a number it is that of a
/// file as the campaign describes one, of the repeats of [synthetic], or of a record that exists.
double planned_sd(const Campaign& campaign, const Condition& condition, Channel channel,
                  const std::vector<Record>& records) {
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
  for (const Record& record : records) {
    const auto series = record.channels.find(channel);
    if (series == record.channels.end() || !(series->second.sd_of_mean > 0.0)) continue;
    const double sd = series->second.sd_of_mean;
    return of_mean(sd * std::sqrt(static_cast<double>(record.repeats)), sd);
  }
  throw InputError(condition.where,
                   fmt::format("condition \"{}\": nothing tells the noise of channel {}, so what "
                               "the planned record tells cannot be said: expected `sd`",
                               condition.id, datasets::info(channel).key));
}

/// A record that a condition would give, without noise.
Record planned_record(const Campaign& campaign, const Condition& condition,
                      const std::vector<Record>& records) {
  Record record;
  record.condition = condition.id;
  record.time_s = datasets::sample_times(condition, nullptr);
  std::vector<Channel> channels;
  std::vector<model::Output> outputs;
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.role != datasets::ChannelRole::output || !datasets::info(channel).is_output)
      continue;
    channels.push_back(channel);
    outputs.push_back(datasets::model_output(channel).value());
  }
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
      series.mean.assign(record.time_s.size(), 0.0);  // its evaluation will say why
    }
    series.sd_of_mean = planned_sd(campaign, condition, channels[k], records);
    record.channels[channels[k]] = series;
  }
  return record;
}

std::vector<double> point_of(const Problem& problem,
                             const std::vector<datasets::FittedValue>* values) {
  std::vector<double> z = problem.start();
  if (values == nullptr) return z;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const Unknown& unknown = problem.map.unknowns()[j];
    for (const auto& value : *values) {
      if (value.index == unknown.index && value.level == unknown.level)
        z[j] = problem.map.to_unit(static_cast<int>(j), value.value);
    }
  }
  return z;
}

/// Jacobian of some conditions and all priors.
Eigen::MatrixXd jacobian_of(const Problem& problem, const Evaluation& at,
                            const std::vector<bool>& counts) {
  const auto n = static_cast<Eigen::Index>(at.z.size());
  RFactor total(n);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!counts[i] || !at.conditions[i].ok()) continue;
    const Eigen::MatrixXd& part = at.conditions[i].r_factor;
    const std::vector<int>& acting = problem.map.acting(i);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(part.rows(), n);
    for (std::size_t j = 0; j < acting.size(); ++j)
      rows.col(acting[j]) = part.col(static_cast<Eigen::Index>(j));
    total.add(rows);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const auto& prior = problem.map.unknowns()[u].prior;
    if (!prior) continue;
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, n);
    row(0, j) = problem.map.slope(static_cast<int>(j), at.z[u]) / prior->sd;
    total.add(row);
  }
  return total.get();
}

/// Only the smoothing of the orifice roots determines what a scaling symmetry leaves open, and that
/// is no physics.
void leave_open(std::size_t unknown, Plan& plan) {
  plan.recorded[unknown].reset();
  plan.all[unknown].reset();
  for (PlannedRecord& record : plan.records) {
    if (!record.alone.empty()) record.alone[unknown].reset();
    if (!record.without.empty()) record.without[unknown].reset();
  }
}

std::string words_of(const Problem& problem, const Plan& plan, std::size_t unknown) {
  const FittedParameter& parameter = plan.parameters[unknown];
  const auto half = relative_half_width(plan.all[unknown], parameter.value);
  if (half && *half <= kWeak) return {};
  const std::string state =
      half ? fmt::format("known to {:.0f} % only", 100.0 * *half) : "not determined";
  const std::string& remedy = plan.remedies[unknown];
  return fmt::format("{}: {} by these records; {}", problem.name(unknown), state,
                     remedy.empty() ? "nothing simple would make it identifiable"
                                    : remedy + " would make it identifiable");
}

}  // namespace

Plan plan(const Campaign& campaign, const std::vector<Record>& records,
          const std::vector<datasets::FittedValue>* values, int threads) {
  std::vector<const Condition*> conditions;
  std::vector<bool> recorded;
  std::vector<Record> all_records = records;
  for (const Condition& condition : campaign.conditions) {
    if (!takes_part(condition)) continue;
    conditions.push_back(&condition);
    recorded.push_back(condition.has_record());
    if (!recorded.back()) all_records.push_back(planned_record(campaign, condition, records));
  }
  if (conditions.empty()) {
    throw InputError({campaign.file.string()},
                     "no condition has use = \"fit\" or \"validate\": expected at least one");
  }
  const Problem problem = make_problem(campaign, all_records, conditions, false, nullptr);
  if (problem.map.unknowns().empty()) {
    throw InputError({campaign.file.string()},
                     "nothing is free: expected `fit = true` at a parameter, or --free");
  }
  const std::vector<double> z = point_of(problem, values);
  const Evaluation at = evaluate_at(problem, z, threads);

  Plan result;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const Unknown& unknown = problem.map.unknowns()[j];
    FittedParameter& parameter = result.parameters.emplace_back();
    parameter.index = unknown.index;
    parameter.scope = unknown.scope;
    parameter.level = unknown.level;
    parameter.value = problem.map.to_physical(static_cast<int>(j), z[j]);
    parameter.lower = unknown.lower;
    parameter.upper = unknown.upper;
    parameter.nuisance = unknown.nuisance;
  }
  const std::vector<bool> everything(conditions.size(), true);
  const Eigen::MatrixXd all = jacobian_of(problem, at, everything);
  result.recorded = cramer_rao(problem, z, jacobian_of(problem, at, recorded));
  result.all = cramer_rao(problem, z, all);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    PlannedRecord& record = result.records.emplace_back();
    record.condition = conditions[i]->id;
    record.recorded = recorded[i];
    if (!at.conditions[i].ok()) {
      record.problem = fmt::format("cannot be simulated at {:g} s: {}",
                                   at.conditions[i].failed_at_s, at.conditions[i].reason);
      continue;
    }
    std::vector<bool> alone(conditions.size(), false);
    alone[i] = true;
    std::vector<bool> without = everything;
    without[i] = false;
    record.alone = cramer_rao(problem, z, jacobian_of(problem, at, alone));
    record.without = cramer_rao(problem, z, jacobian_of(problem, at, without));
  }
  if (values == nullptr) {
    result.messages.push_back(
        "these are figures at the campaign's start values; with --fit at those of a fit, which "
        "tell more where the starts are far off");
  }
  const auto symmetry = at.ok ? scaling_symmetry(problem, z, 1.0, threads) : std::nullopt;
  const std::string symmetric = symmetry ? describe(problem, *symmetry) : "";
  if (!symmetric.empty()) result.messages.push_back(symmetric);
  std::vector<bool> open(z.size(), false);
  if (symmetry && symmetry->holds()) {
    for (const std::size_t j : symmetry->unknowns) {
      open[j] = true;
      leave_open(j, result);
    }
  }
  for (const std::string& name : uncertain_names(problem)) {
    result.messages.push_back(fmt::format(
        "the uncertainty of {} is not in these figures: a fit adds what it does to them", name));
  }
  for (std::size_t j = 0; j < z.size(); ++j) {
    const auto half = relative_half_width(result.all[j], result.parameters[j].value);
    const bool wanting = !problem.map.unknowns()[j].nuisance && (!half || *half > kWeak);
    result.remedies.push_back(
        open[j]   ? symmetry_remedy(problem, *symmetry)
        : wanting ? fmt::format("{}", fmt::join(remedies(problem, z, all, j), ", or "))
                  : "");
    if (!wanting) continue;
    const std::string text = words_of(problem, result, j);
    if (!text.empty()) result.messages.push_back(text);
  }
  return result;
}

}  // namespace rigcal::calib
