#include "report/run/missing_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/plant/parameter_values.hpp"
#include "model/simulate.hpp"

namespace rigcal::report {
namespace {

/// Half-width of the bounds, as a multiple of the size that the residuals suggest.
constexpr double kWidestTerm = 10.0;

/// Whether a key is one of the gains kp and kd, which every loop has anyway.
bool is_stated_gain(std::string_view key) {
  return std::any_of(
      model::kFeedbacks.begin(), model::kFeedbacks.end(),
      [key](const model::FeedbackRow& loop) { return key == loop.kp || key == loop.kd; });
}

}  // namespace

std::vector<MissingTerm> missing_terms(model::PlantKind plant,
                                       const calib::Considered& considered) {
  std::vector<MissingTerm> terms;
  for (const std::string& key : considered.missing) {
    const calib::ConsideredEffect* effect = considered.find(key);
    if (effect == nullptr || !effect->alone) continue;
    const double size = *effect->alone;
    const int index = model::parameter_index(plant, key);
    if (index < 0) continue;
    const auto& spec = model::parameter_spec(plant, index);
    // A wrong value of a parameter that every campaign specifies is not a missing term.
    if (!spec.default_value || is_stated_gain(key)) continue;
    const auto number = [&](double value) {
      return spec.unit == "1" ? fmt::format("{:.3g}", value)
                              : fmt::format("\"{:.3g} {}\"", value, spec.unit);
    };
    if (!spec.can_be_fitted) {
      terms.push_back({spec.kind == model::ParameterKind::controller,
                       fmt::format("{} = {}", key, number(size))});
      continue;
    }
    // The neutral value is the default of a gain, and zero for all other terms.
    const double start = spec.default_value.value_or(0.0) + size;
    const double reach = kWidestTerm * std::abs(size);
    terms.push_back({spec.kind == model::ParameterKind::controller,
                     fmt::format("{} = {{ start = {}, lower = {}, upper = {}, fit = true }}", key,
                                 number(start), number(std::max(spec.lower, start - reach)),
                                 number(std::min(spec.upper, start + reach)))});
  }
  return terms;
}

std::string with_terms(std::string campaign, const std::vector<MissingTerm>& terms) {
  for (const bool of_controller : {false, true}) {
    const std::string head = of_controller ? "\n[rig.controller]\n" : "\n[rig.parameters]\n";
    const std::size_t place = campaign.find(head);
    std::string lines;
    for (const MissingTerm& each : terms) {
      if (each.of_controller == of_controller) lines += each.line + "\n";
    }
    if (lines.empty()) continue;
    if (place == std::string::npos) {
      campaign += head + lines;
    } else {
      campaign.insert(place + head.size(), lines);
    }
  }
  return campaign;
}

}  // namespace rigcal::report
