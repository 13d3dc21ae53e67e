#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::datasets {

/// Name of a quantity that may differ between days, as used in [between_days].
struct DayQuantityName {
  std::string key;
  std::string unit;  ///< SI
};

/// Key for the start time of a record relative to its drive. No parameter of the rig describes it.
inline constexpr const char* kTriggerKey = "trigger";

/// Returns the quantities that the plant has among supply, oil, zero of the position sensor, and
/// trigger.
std::vector<DayQuantityName> day_quantity_names(model::PlantKind plant);

/// Section [between_days]: how much quantities vary between days.
struct BetweenDaysSettings {
  bool none = false;                  ///< `between_days = false`: days do not differ
  std::map<std::string, double> sds;  ///< standard deviation between days in SI units, by key
  std::set<std::string> left_out;     ///< quantities that the campaign sets to `false`

  bool leaves_out(const std::string& key) const { return none || left_out.contains(key); }
  std::optional<double> sd(const std::string& key) const {
    const auto found = sds.find(key);
    return found == sds.end() ? std::nullopt : std::optional(found->second);
  }
  /// Whether the campaign states anything here. If so, no standard deviation is estimated.
  bool is_stated() const { return none || !sds.empty() || !left_out.empty(); }
};

}  // namespace rigcal::datasets
