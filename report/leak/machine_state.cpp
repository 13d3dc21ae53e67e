#include "report/leak/machine_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/leak/leak_estimate.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using diagnosis::LimitDistance;
using diagnosis::MachineState;

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
      " {} disagree (coefficients {:.3g} to {:.3g}, {}): one leak cannot explain all, or the fit "
      "is "
      "wrong. Interval widened (Birge).",
      signals_of(state), low->coefficient, high->coefficient, p_value_text(state.pooled.p));
}

std::string limit_of(const LimitDistance& limit) {
  const std::string name(to_string(limit.class_));
  if (limit.on_limit) {
    return fmt::format(
        ", interval includes the limit between {} and {} ({:g} %)",
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
  if (state.is_reference)
    return fmt::format("{}: the healthy reference, whose leak is zero by construction.", name);
  if (!state.ok()) {
    return fmt::format(
        "{}: no verdict: {}.", name,
        state.failure.empty() ? "none of its conditions gives its leak" : state.failure);
  }
  const diagnosis::LeakEstimate& e = state.estimate;
  if (e.incompatible) {
    return fmt::format(
        "{}: incompatible with the model: the coefficient would be {:.3g} ({:.3g} to "
        "{:.3g}), below zero by more than its error, so supply or valve are not as they were in "
        "the "
        "fit.{}",
        name, e.coefficient, e.ci95.low, e.ci95.high, agreement_of(state));
  }
  if (!e.has_share()) {
    return fmt::format(
        "{}: undecided: a coefficient of {:.3g} would leak more than the servo valve "
        "delivers at {}.{}",
        name, e.coefficient, state.duty, agreement_of(state));
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
                       low == high ? "sure to 0.01 %" : fmt::format("{} to {} %", low, high),
                       state.duty);
  } else {
    text = fmt::format("{}: no leak is detected, less than {:.2g} % of the servo flow leaks at {}",
                       name, std::max(0.01, kInPercent * e.share_ci95.high), state.duty);
  }
  const double probability = e.probability[static_cast<std::size_t>(e.most_probable)];
  text += state.leak_class
              ? fmt::format(": {} (probability {:.2f})", to_string(*state.leak_class), probability)
              : fmt::format(": undecided, {} with a probability of {:.2f} only",
                            to_string(e.most_probable), probability);
  return text + limit_of(state.limit) + "." + agreement_of(state);
}

StoredState stored(const MachineState& state) {
  const diagnosis::LeakEstimate& e = state.estimate;
  StoredState told;
  told.state = state.key.name();
  told.leak_level = unless_empty(state.key.leak_level);
  told.specimen = unless_empty(state.key.specimen);
  told.date = unless_empty(state.key.date);
  told.sentence = state_sentence(state);
  told.failure = unless_empty(state.failure);
  told.is_reference = state.is_reference;
  for (const auto& member : state.members) told.conditions.push_back(member.condition);
  told.left_out = state.left_out;
  told.leak = stored(e, state.leak_class, state.ok());
  told.duty = unless_empty(state.duty);
  if (!state.ok()) return told;
  if (e.incompatible) return told;
  if (state.leak_area_m2) {
    const double area = e.coefficient != 0.0 ? *state.leak_area_m2 / e.coefficient : 0.0;
    told.leak_area_m2 = std::max(0.0, *state.leak_area_m2);
    if (e.standard_error > 0.0) told.leak_area_ci95_m2 = scaled_ends(e.ci95, area);
  }
  if (e.has_share()) told.nearest_limit = state.limit;
  if (state.members.size() > 1) told.agreement = state.pooled;
  return told;
}

}  // namespace rigcal::report
