#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::datasets {

/// A quantity whose size a campaign may state in [considered] or [between_days].
struct SizedQuantity {
  std::string key;
  std::string unit;  ///< SI unit of the size
};

/// Returns the effects that can be considered for a plant: optional terms, by the key of their
/// parameter; volumes that hoses may enlarge; and effects that no parameter describes
/// ("supply_sag", "position_hysteresis", "valve_hysteresis").
std::vector<SizedQuantity> effect_names(model::PlantKind plant);

/// Key for the start time of a record relative to its drive. No parameter of the rig describes it.
inline constexpr const char* kTriggerKey = "trigger";

/// Returns the quantities that may differ from day to day: the trigger, and the supply pressure,
/// the oil and the zero of the position sensor if the plant has them.
std::vector<SizedQuantity> day_quantity_names(model::PlantKind plant);

/// Section [considered], for small effects that the model leaves out, or [between_days].
struct StatedSizes {
  bool none = false;                    ///< the section is `false`: no quantity counts
  std::map<std::string, double> sizes;  ///< standard deviations (SI) that replace defaults, by key
  std::set<std::string> left_out;       ///< keys that the campaign sets to `false`

  bool leaves_out(const std::string& key) const { return none || left_out.contains(key); }
  std::optional<double> size(const std::string& key) const {
    const auto found = sizes.find(key);
    return found == sizes.end() ? std::nullopt : std::optional(found->second);
  }
  /// Whether the campaign states anything here.
  bool is_stated() const { return none || !sizes.empty() || !left_out.empty(); }
};

}  // namespace rigcal::datasets
