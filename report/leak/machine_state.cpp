#include "report/leak/machine_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/leak/leak_estimate_json.hpp"
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
  if (!state.pooled.disagree) return fmt::format(" {} agree.", signals_of(state));
  const auto [low, high] = std::minmax_element(
      state.members.begin(), state.members.end(),
      [](const auto& a, const auto& b) { return a.coefficient < b.coefficient; });
  return fmt::format(
      " {} disagree (coefficients {:.3g} to {:.3g}, {}): no one leak explains them, or the fit is "
      "wrong; the interval is widened for it.",
      signals_of(state), low->coefficient, high->coefficient, p_value_text(state.pooled.p));
}

std::string limit_of(const LimitDistance& limit) {
  const std::string name(to_string(limit.above));
  if (limit.on_limit) {
    return fmt::format(", on the limit between {} and {} ({:g} %)",
                       to_string(datasets::kLeakClasses[static_cast<std::size_t>(limit.above) - 1]),
                       name, kInPercent * limit.limit);
  }
  return fmt::format(
      ", {:.1f} percentage points {} {} ({:g} %)", kInPercent * std::abs(limit.distance),
      limit.distance < 0.0 ? "below" : "above",
      limit.distance < 0.0 ? name : "the limit of " + name, kInPercent * limit.limit);
}

}  // namespace

std::string state_sentence(const MachineState& state) {
  const std::string name = state.key.name();
  if (state.is_reference)
    return fmt::format("{}: the healthy reference, whose leak is zero by construction.", name);
  if (!state.ok()) {
    return fmt::format("{}: no verdict: {}.", name,
                       state.failure.empty() ? "no condition of it tells its leak" : state.failure);
  }
  const diagnosis::LeakEstimate& e = state.estimate;
  // Two decimals at most: of an operator's percentages no more can be meant.
  const double error = std::max(0.1, kInPercent * (e.share_ci95.second - e.share_ci95.first) / 4.0);
  const auto percent = [&](double fraction) { return matched(kInPercent * fraction, error); };
  std::string text;
  if (e.leak_detected) {
    const std::string low = percent(e.share_ci95.first);
    const std::string high = percent(e.share_ci95.second);
    text = fmt::format("{}: {} % of the servo flow leaks ({}) at {}", name, percent(e.share),
                       low == high ? "sure to 0.01 %" : fmt::format("{} to {} %", low, high),
                       state.duty);
  } else {
    text = fmt::format("{}: no leak is detected, less than {:.2g} % of the servo flow leaks at {}",
                       name, std::max(0.01, kInPercent * e.share_ci95.second), state.duty);
  }
  const double probability = e.probability[static_cast<std::size_t>(e.most_probable)];
  text += state.leak_class
              ? fmt::format(": {} (probability {:.2f})", to_string(*state.leak_class), probability)
              : fmt::format(": undecided, {} with a probability of {:.2f} only",
                            to_string(e.most_probable), probability);
  return text + limit_of(state.limit) + "." + agreement_of(state);
}

Json state_json(const MachineState& state) {
  const bool ok = state.ok();
  const diagnosis::LeakEstimate& e = state.estimate;
  const auto text = [](const std::string& x) { return x.empty() ? Json(nullptr) : Json(x); };
  const auto name = [](datasets::LeakClass x) { return std::string(to_string(x)); };
  Json json;
  json["state"] = state.key.name();
  json["leak_level"] = text(state.key.leak_level);
  json["specimen"] = text(state.key.specimen);
  json["date"] = text(state.key.date);
  json["sentence"] = state_sentence(state);
  json["failure"] = text(state.failure);
  json["is_reference"] = state.is_reference;
  json["conditions"] = Json::array();
  for (const auto& member : state.members) json["conditions"].push_back(member.condition);
  json["left_out"] = state.left_out;
  json.update(leak_estimate_json(e, state.leak_class, ok));
  const double area = e.coefficient != 0.0 ? state.leak_area_m2 / e.coefficient : 0.0;
  json["leak_area_m2"] = ok ? number(std::max(0.0, state.leak_area_m2)) : Json(nullptr);
  json["leak_area_ci95_m2"] = ok ? interval_json(e.ci95, area) : Json(nullptr);
  json["duty"] = text(state.duty);
  json["nearest_limit"] = nullptr;
  if (ok) {
    json["nearest_limit"] = {
        {"class", name(state.limit.above)},
        {"percent", number(kInPercent * state.limit.limit)},
        {"distance_percentage_points", number(kInPercent * state.limit.distance)},
        {"on_limit", state.limit.on_limit}};
  }
  json["agreement"] = nullptr;
  if (ok && state.members.size() > 1) {
    json["agreement"] = {{"p", number(state.pooled.p)},
                         {"chi_squared", number(state.pooled.chi_squared)},
                         {"freedom", number(state.pooled.freedom)},
                         {"widened", number(state.pooled.widened)},
                         {"agree", !state.pooled.disagree}};
  }
  return json;
}

}  // namespace rigcal::report
