#include "diagnosis/machine/state_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/significant.hpp"

namespace rigcal::diagnosis {
namespace {

std::string signals_of(const MachineState& state) {
  std::set<std::string> signals;
  for (const auto& member : state.members) signals.insert(member.signal);
  return fmt::format("{} signal{}", signals.size(), signals.size() == 1 ? "" : "s");
}

std::string agreement_of(const MachineState& state) {
  if (state.members.size() < 2) return fmt::format(" From {} alone.", signals_of(state));
  if (state.pooled.agree) return fmt::format(" {} agree.", signals_of(state));
  const auto [low, high] = std::minmax_element(
      state.members.begin(), state.members.end(),
      [](const auto& a, const auto& b) { return a.coefficient < b.coefficient; });
  return fmt::format(
      " {} disagree (coefficients {} to {}, {}): one leak cannot explain all, or the fit "
      "is wrong. The interval includes their disagreement.",
      signals_of(state), significant(low->coefficient, 3), significant(high->coefficient, 3),
      p_value_text(state.pooled.p));
}

/// @param share_ci95  fractions of one
std::string limit_of(const LimitDistance& limit, const Range& share_ci95) {
  const std::string name(to_string(limit.class_));
  if (limit.on_limit) {
    const bool includes = kInPercent * share_ci95.low <= limit.percent &&
                          limit.percent <= kInPercent * share_ci95.high;
    return fmt::format(
        ", {} the limit between {} and {} ({:g} %)",
        includes ? "interval includes" : "within 5 % of",
        to_string(datasets::kLeakClasses[static_cast<std::size_t>(limit.class_) - 1]), name,
        limit.percent);
  }
  const bool below = limit.distance_percentage_points < 0.0;
  return fmt::format(", {:.1f} percentage points {} {} ({:g} %)",
                     std::abs(limit.distance_percentage_points), below ? "below" : "above",
                     below ? name : "the limit of " + name, limit.percent);
}

}  // namespace

std::string state_sentence(const MachineState& state) {
  const std::string name = state.key.name();
  const std::string duty = state.duty.value_or("");
  if (state.is_reference)
    return fmt::format("{}: the healthy reference, whose leak is zero by construction.", name);
  if (!state.ok()) {
    return fmt::format("{}: no verdict: {}.", name,
                       state.failure.value_or("none of its conditions determines its leak"));
  }
  const LeakEstimate& e = state.estimate;
  if (e.incompatible) {
    return fmt::format(
        "{}: incompatible with the model: the coefficient would be {} ({} to {}), "
        "below zero by more than its error, so supply or valve have changed since the fit.{}",
        name, significant(e.coefficient, 3), significant(e.ci95.low, 3),
        significant(e.ci95.high, 3), agreement_of(state));
  }
  if (!e.has_share()) {
    return fmt::format(
        "{}: undecided: a coefficient of {:.3g} would leak more than the servo valve "
        "delivers at {}.{}",
        name, e.coefficient, duty, agreement_of(state));
  }
  // Percentages have at most two decimals, because an operator has no use for more.
  const double error = std::max(0.1, kInPercent * (e.share_ci95.high - e.share_ci95.low) / 4.0);
  const auto percent = [&](double fraction) {
    return to_uncertainty(kInPercent * fraction, error);
  };
  std::string text;
  if (e.leak_detected) {
    const std::string low = percent(e.share_ci95.low);
    const std::string high = percent(e.share_ci95.high);
    text = fmt::format("{}: {} % of the servo flow leaks ({}) at {}", name, percent(e.share),
                       low == high ? "uncertain by 0.01 %" : fmt::format("{} to {} %", low, high),
                       duty);
  } else {
    text = fmt::format("{}: no leak is detected, less than {:.2g} % of the servo flow leaks at {}",
                       name, std::max(0.01, kInPercent * e.share_ci95.high), duty);
  }
  const double probability = e.probability[static_cast<std::size_t>(e.most_probable)];
  text += state.leak.class_
              ? fmt::format(": {} (probability {:.2f})", to_string(*state.leak.class_), probability)
              : fmt::format(": undecided, {} with a probability of {:.2f} only",
                            to_string(e.most_probable), probability);
  const std::string limit = state.nearest_limit ? limit_of(*state.nearest_limit, e.share_ci95) : "";
  return text + limit + "." + agreement_of(state);
}

void give_verdict(const datasets::DiagnosisSettings& settings, MachineState& state) {
  const LeakEstimate& e = state.estimate;
  state.state = state.key.name();
  for (const StateMember& member : state.members) state.conditions.push_back(member.condition);
  if (state.ok()) state.leak = stated(e, settings.least_probability);
  if (!state.leak.leakage_coefficient) {
    state.leak_area_m2.reset();
  } else {
    if (state.leak_area_m2) {
      const double area = e.coefficient != 0.0 ? *state.leak_area_m2 / e.coefficient : 0.0;
      state.leak_area_m2 = std::max(0.0, *state.leak_area_m2);
      if (e.standard_error > 0.0) state.leak_area_ci95_m2 = area * e.ci95;
    }
    if (e.has_share()) state.nearest_limit = nearest_limit(e, settings);
    if (state.members.size() > 1) state.agreement = state.pooled;
  }
  state.sentence = state_sentence(state);
}

std::vector<const MachineState*> judged_states(const std::vector<MachineState>& states) {
  std::vector<const MachineState*> judged;
  for (const MachineState& state : states)
    if (!state.is_reference) judged.push_back(&state);
  std::stable_sort(judged.begin(), judged.end(), [](const auto* a, const auto* b) {
    return a->leak.leak_share_percent.value_or(-1.0) > b->leak.leak_share_percent.value_or(-1.0);
  });
  return judged;
}

Finding finding_of(const std::vector<MachineState>& states) {
  const std::vector<const MachineState*> judged = judged_states(states);
  const auto all = [&](auto is) { return std::all_of(judged.begin(), judged.end(), is); };
  if (!all([](const auto* state) {
        return state->leak.class_.value_or(LeakClass::normal) == LeakClass::normal;
      }))
    return Finding::leak;
  if (all([](const auto* state) { return !state->leak.class_; })) return Finding::not_judged;
  return all([](const auto* state) { return state->leak.class_.has_value(); }) ? Finding::no_leak
                                                                               : Finding::unclear;
}

}  // namespace rigcal::diagnosis
