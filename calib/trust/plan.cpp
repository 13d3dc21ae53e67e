#include "calib/trust/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calib/search/evaluator.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "calib/trust/planned_record.hpp"
#include "calib/trust/symmetry.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::Record;

/// Removes the standard deviations of an unknown that a scaling symmetry leaves undetermined. They
/// are only due to the smoothing of the orifice roots, which has no physical meaning.
void leave_open(std::size_t unknown, Plan& plan) {
  plan.parameters[unknown].sd_recorded.reset();
  plan.parameters[unknown].sd_all.reset();
  for (PlannedRecord& record : plan.records) {
    if (!record.sd_alone.empty()) record.sd_alone[unknown].reset();
    if (!record.sd_without.empty()) record.sd_without[unknown].reset();
  }
}

std::string words_of(const Problem& problem, const Plan& plan, std::size_t unknown) {
  const PlannedParameter& parameter = plan.parameters[unknown];
  const auto half = relative_half_width(parameter.sd_all, parameter.value);
  if (half && *half <= kWeak) return {};
  const std::string state =
      half ? fmt::format("known to {:.0f} % only", 100.0 * *half) : "not determined";
  return fmt::format("{}: {} from these records; {} would make it identifiable",
                     problem.name(unknown), state, parameter.remedy.value_or("nothing simple"));
}

}  // namespace

Plan plan(const Campaign& campaign, const std::vector<Record>& records,
          const std::vector<datasets::FittedValue>* values, int threads) {
  std::vector<const Condition*> conditions;
  std::vector<bool> recorded;
  std::vector<Record> all_records = records;
  for (const Condition& condition : campaign.conditions) {
    if (!is_planned_with(condition)) continue;
    conditions.push_back(&condition);
    recorded.push_back(condition.has_record());
    if (recorded.back()) continue;
    const auto sd = [&](datasets::Channel channel) {
      return planned_sd(campaign, condition, channel, records);
    };
    all_records.push_back(planned_record(campaign, condition, sd));
  }
  if (conditions.empty()) {
    throw InputError({campaign.file.string()},
                     "no condition has use = \"fit\" or \"validate\": expected at least one");
  }
  const Problem problem = make_problem(campaign, all_records, conditions, false, nullptr);
  if (problem.map.unknowns().empty()) {
    throw InputError({campaign.file.string()},
                     "no parameter is free: expected `fit = true` at a parameter, or --free");
  }
  const std::vector<double> z = point_at(problem, values);
  const Evaluation at = evaluate_at(problem, z, threads);

  Plan result;
  const std::vector<double> everything(conditions.size(), 1.0);
  const std::vector<double> existing(recorded.begin(), recorded.end());
  const Eigen::MatrixXd all = weighted_jacobian(problem, at, everything);
  const auto sd_recorded = cramer_rao(problem, z, weighted_jacobian(problem, at, existing));
  const auto sd_all = cramer_rao(problem, z, all);
  for (std::size_t j = 0; j < z.size(); ++j)
    result.parameters.push_back({parameter_at(problem, z, j), problem.map.unknowns()[j].nuisance,
                                 sd_recorded[j], sd_all[j], std::nullopt});
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    PlannedRecord& record = result.records.emplace_back();
    record.condition = conditions[i]->id;
    record.recorded = recorded[i];
    record.sd_alone.resize(z.size());
    record.sd_without.resize(z.size());
    if (!at.conditions[i].ok()) {
      record.problem = fmt::format("cannot be simulated at {:g} s: {}",
                                   at.conditions[i].failed_at_s, at.conditions[i].reason);
      continue;
    }
    std::vector<double> alone(conditions.size(), 0.0);
    alone[i] = 1.0;
    std::vector<double> without = everything;
    without[i] = 0.0;
    record.sd_alone = cramer_rao(problem, z, weighted_jacobian(problem, at, alone));
    record.sd_without = cramer_rao(problem, z, weighted_jacobian(problem, at, without));
  }
  if (values == nullptr) {
    result.messages.push_back(
        "these figures apply to the campaign's start values; if these are far off, use --fit with "
        "an earlier fit");
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
    result.messages.push_back(
        fmt::format("these figures do not include the uncertainty of {}; a fit does", name));
  }
  for (std::size_t j = 0; j < z.size(); ++j) {
    PlannedParameter& parameter = result.parameters[j];
    const auto half = relative_half_width(parameter.sd_all, parameter.value);
    const bool wanting = !parameter.nuisance && (!half || *half > kWeak);
    parameter.remedy =
        unless_empty(open[j]   ? symmetry_remedy(problem, *symmetry)
                     : wanting ? fmt::format("{}", fmt::join(remedies(problem, z, all, j), ", or "))
                               : "");
    if (!wanting) continue;
    const std::string text = words_of(problem, result, j);
    if (!text.empty()) result.messages.push_back(text);
  }
  return result;
}

}  // namespace rigcal::calib
