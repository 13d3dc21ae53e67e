#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::datasets {

/// A small effect that a model may leave out, as [considered] names it.
struct EffectName {
  std::string key;
  std::string unit;  ///< SI unit of its size
};

/// Effects that may be considered with a plant: optional terms by the key of their parameter,
/// volumes that hoses may enlarge, and what no parameter describes ("supply_sag",
/// "position_hysteresis", "valve_hysteresis").
std::vector<EffectName> effect_names(model::PlantKind plant);

/// [considered]: what the campaign says of the small effects that its model leaves out.
struct ConsideredSettings {
  bool none = false;                    ///< `considered = false`: the model counts as exact
  std::map<std::string, double> sizes;  ///< standard deviation, SI, in place of the usual one
  std::set<std::string> left_out;       ///< effects that the campaign sets to `false`

  bool leaves_out(const std::string& effect) const { return none || left_out.contains(effect); }
  std::optional<double> size(const std::string& effect) const {
    const auto found = sizes.find(effect);
    return found == sizes.end() ? std::nullopt : std::optional(found->second);
  }
};

}  // namespace rigcal::datasets
