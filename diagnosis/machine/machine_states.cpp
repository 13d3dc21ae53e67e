#include "diagnosis/machine/machine_states.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "diagnosis/machine/state_verdict.hpp"
#include "diagnosis/record/duty.hpp"
#include "diagnosis/record/leak_budget.hpp"
#include "diagnosis/record/signal_name.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Condition;

/// Returns the duty for which the shares of states are stated.
const Prepared& duty_of(const Campaign& campaign, const std::vector<Prepared>& all) {
  const std::string& wanted = campaign.diagnosis.duty;
  std::vector<const Condition*> conditions;
  for (const Prepared& each : all) conditions.push_back(each.condition);
  if (const auto duty = duty_among(conditions, wanted)) return all[*duty];
  throw InputError(
      {campaign.file.string()},
      fmt::format("diagnosis.duty: no condition \"{}\" that can be diagnosed: expected "
                  "the id of one",
                  wanted));
}

/// Adds the average of a condition to the members, or the reason why it is left out.
void add_average(const RecordDiagnosis& record, const SignalErrors& errors, MachineState& state) {
  const auto leave_out = [&](const std::string& why) {
    state.left_out.push_back(record.condition + ": " + why);
  };
  if (!record.fit.ok()) return leave_out(record.fit.failure);
  if (record.is_reference) return leave_out("the healthy reference of its signal");
  if (record.explained_by_leak == false) return leave_out("not explained by a leak");
  const CoefficientError error =
      coefficient_error(record.fit, errors, record.repeats_averaged, record.reference_repeats);
  if (!(error.own_se > 0.0))
    return leave_out("its residuals contain no noise, so its standard error is unknown");
  state.members.push_back({record.condition, record.signal, record.fit.coefficient, error.own_se,
                           error.freedom, record.fit.rig_moves, record.fit.day_effects,
                           record.days.difference()});
}

/// Returns the error of the share at the duty due to day-to-day differences, both through the
/// coefficient and directly.
double share_days_error(const LeakProblem& problem, const Prepared& duty, const DayVariance& days,
                        const LeakFit& leak, const MachineState& state) {
  const Eigen::VectorXd& weights = state.pooled.day_weights;
  if (!(days.factor > 0.0) || weights.size() == 0 || !(weights.norm() > 0.0)) return 0.0;
  LeakFit itself = leak;
  const auto quantities = static_cast<Eigen::Index>(problem.day_quantities.size());
  itself.day_effects = Eigen::VectorXd::Zero(quantities);
  StateMember direct;
  direct.day_effects = share_day_effects(problem, *duty.condition, duty.records->average, itself,
                                         state.share_slope, *duty.day_leaks, duty.negligible());
  direct.day_weights = weights;
  return std::sqrt(days.factor) *
         (state.share_slope * state.pooled.day_moves + direct.day_moves()).norm();
}

void judge_state(const LeakProblem& problem, const RigFit& rig, const Prepared& duty,
                 const DayVariance& days, MachineState& state) {
  if (state.members.empty()) return;
  const Campaign& campaign = problem.campaign;
  state.pooled = pooled_leak(state.members, rig.covariance, days);
  if (campaign.diagnosis.leak_law == datasets::LeakLaw::orifice)
    state.leak_area_m2 =
        state.pooled.coefficient * datasets::values_in(campaign, *duty.condition)["leakage_area"];
  state.duty = signal_name(campaign, *duty.condition);
  LeakFit leak;
  leak.coefficient = state.pooled.coefficient;
  leak.rig_moves = state.pooled.rig_moves;
  const double reach = std::max(state.pooled.error.half_width(), duty.least_reach());
  try {
    const datasets::Record& average = duty.records->average;
    const LeakCurve curve =
        leak_curve_of(problem, *duty.condition, average, leak.coefficient, reach, *duty.leaks);
    state.share_slope = curve.share_slope(leak.coefficient);
    const Eigen::VectorXd share_moves =
        share_rig_moves(problem, rig, *duty.condition, average, leak, state.share_slope,
                        *duty.leaks, duty.negligible(), duty.effects.get());
    const double share_days_se = share_days_error(problem, duty, days, leak, state);
    const double share_se = std::hypot(rig.error(share_moves), share_days_se);
    const PooledLeak& pooled = state.pooled;
    state.estimate =
        estimate_leak(leak.coefficient, pooled.error, curve, share_se, campaign.diagnosis);
    state.estimate.budget = coefficient_budget(pooled.error, rig.contributions(pooled.rig_moves));
    state.estimate.share_budget = share_budget(pooled.error, state.share_slope,
                                               rig.contributions(share_moves), share_days_se);
  } catch (const NoResultError& failure) {
    state.failure = failure.what();
  }
}

}  // namespace

std::vector<MachineState> machine_states(const LeakProblem& problem, const RigFit& rig,
                                         const std::vector<Prepared>& all,
                                         const std::vector<RecordDiagnosis>& records,
                                         const std::map<std::string, SignalErrors>& errors,
                                         const DayVariance& days) {
  std::vector<MachineState> states;
  if (all.empty()) return states;
  for (const RecordDiagnosis& record : records) {
    if (record.repeat) continue;
    const StateKey key = state_of(*problem.campaign.find(record.condition));
    auto state = std::find_if(states.begin(), states.end(),
                              [&](const MachineState& each) { return each.key == key; });
    if (state == states.end()) {
      states.emplace_back().key = key;
      state = std::prev(states.end());
      state->is_reference = true;
    }
    state->is_reference = state->is_reference && record.is_reference;
    const auto own = errors.find(record.signal);
    add_average(record, own == errors.end() ? SignalErrors{} : own->second, *state);
  }
  const Prepared& duty = duty_of(problem.campaign, all);
  for (MachineState& state : states) {
    if (!duty.failure.empty()) state.failure = duty.failure;
    if (!state.failure) judge_state(problem, rig, duty, days, state);
    give_verdict(problem.campaign.diagnosis, state);
  }
  return states;
}

}  // namespace rigcal::diagnosis
