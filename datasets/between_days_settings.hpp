#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::datasets {

/// A quantity that differs between days, as [between_days] names it.
struct DayQuantityName {
  std::string key;
  std::string unit;  ///< SI
};

/// The start of a record against its drive, which no parameter of the rig describes.
inline constexpr const char* kTriggerKey = "trigger";

/// Supply, oil, zero of the position sensor, and trigger, as far as the plant has them.
std::vector<DayQuantityName> day_quantity_names(model::PlantKind plant);

/// [between_days]: by how much quantities differ between days.
struct BetweenDaysSettings {
  bool none = false;                  ///< `between_days = false`: every day is like the others
  std::map<std::string, double> sds;  ///< standard deviation between days, SI, by key
  std::set<std::string> left_out;     ///< quantities that the campaign sets to `false`

  bool leaves_out(const std::string& key) const { return none || left_out.contains(key); }
  std::optional<double> sd(const std::string& key) const {
    const auto found = sds.find(key);
    return found == sds.end() ? std::nullopt : std::optional(found->second);
  }
  /// Whether the campaign states any size, so that none is estimated.
  bool is_stated() const { return none || !sds.empty() || !left_out.empty(); }
};

}  // namespace rigcal::datasets
