#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::datasets {

/// A small effect that a model may leave out, as named in [considered].
struct EffectName {
  std::string key;
  std::string unit;  ///< SI unit of its size
};

/// Returns the effects that can be considered for a plant: optional terms, by the key of their
/// parameter; volumes that hoses may enlarge; and effects that no parameter describes
/// ("supply_sag", "position_hysteresis", "valve_hysteresis").
std::vector<EffectName> effect_names(model::PlantKind plant);

/// Section [considered]: the small effects that the model leaves out.
struct ConsideredSettings {
  bool none = false;                    ///< `considered = false`: the model is taken to be exact
  std::map<std::string, double> sizes;  ///< standard deviations (SI) that replace defaults
  std::set<std::string> left_out;       ///< effects that the campaign sets to `false`

  bool leaves_out(const std::string& effect) const { return none || left_out.contains(effect); }
  std::optional<double> size(const std::string& effect) const {
    const auto found = sizes.find(effect);
    return found == sizes.end() ? std::nullopt : std::optional(found->second);
  }
};

}  // namespace rigcal::datasets
