#include "diagnosis/record/obstacles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;

/// Collects reasons, and the conditions to which each applies, in order of first appearance.
class Reasons {
 public:
  void add(const std::string& reason, const std::string& condition) {
    auto [entry, is_new] = conditions_.try_emplace(reason);
    if (is_new) order_.push_back(reason);
    entry->second.push_back(condition);
  }
  std::vector<std::string> in_words(std::size_t conditions) const {
    std::vector<std::string> result;
    for (const std::string& reason : order_) {
      const std::vector<std::string>& named = conditions_.at(reason);
      result.push_back(named.size() == conditions
                           ? reason
                           : fmt::format("{} (condition {})", reason, fmt::join(named, ", ")));
    }
    return result;
  }

 private:
  std::map<std::string, std::vector<std::string>> conditions_;
  std::vector<std::string> order_;
};

/// Values that a factor has in healthy and in leaking conditions.
struct FactorValues {
  std::set<std::string> healthy;
  std::set<std::string> leaking;
};

template <typename ValueOf>
void add_confounded(const Campaign& campaign, std::string_view factor, ValueOf value_of,
                    std::vector<std::string>& result) {
  FactorValues values;
  for (const Condition* condition : diagnosed_conditions(campaign)) {
    const std::optional<std::string> value = value_of(*condition);
    if (!value || !condition->leak_level) continue;
    (is_healthy(campaign, *condition) ? values.healthy : values.leaking).insert(*value);
  }
  if (values.healthy.empty() || values.leaking.empty()) return;
  const bool shared = std::any_of(values.leaking.begin(), values.leaking.end(),
                                  [&](const auto& each) { return values.healthy.contains(each); });
  if (shared) return;
  result.push_back(
      fmt::format("leak level and {0} are confounded: healthy records come from {0} {1}, the "
                  "others from {2}; the differences may be due to the {0} and not to a leak",
                  factor, fmt::join(values.healthy, ", "), fmt::join(values.leaking, ", ")));
}

}  // namespace

std::vector<const Condition*> diagnosed_conditions(const Campaign& campaign) {
  std::vector<const Condition*> result;
  for (const Condition& condition : campaign.conditions) {
    if (condition.use != datasets::Use::ignore) result.push_back(&condition);
  }
  return result;
}

std::vector<std::string> lacks_for_diagnosis(const Campaign& campaign, const Condition& condition) {
  std::vector<std::string> result = lacks_for_model(campaign, condition);
  const auto position = campaign.channels.find(Channel::position);
  const auto& listed = campaign.fit.outputs;
  if (position == campaign.channels.end() ||
      position->second.role != datasets::ChannelRole::output ||
      (!listed.empty() &&
       std::find(listed.begin(), listed.end(), Channel::position) == listed.end())) {
    result.emplace_back(
        "the position is not recorded as an output, and the parity residual is one "
        "of positions");
  }
  return result;
}

bool is_healthy(const Campaign& campaign, const Condition& condition) {
  if (!condition.leak_level) return false;
  const auto known = campaign.diagnosis.level_class.find(*condition.leak_level);
  if (known != campaign.diagnosis.level_class.end())
    return known->second == datasets::LeakClass::normal;
  const auto level = campaign.leak_levels.find(*condition.leak_level);
  if (level == campaign.leak_levels.end()) return false;
  const int leak = model::parameter_index(campaign.rig.plant,
                                          datasets::leak_parameter(campaign.diagnosis.leak_law));
  return std::any_of(level->second.begin(), level->second.end(), [leak](const auto& entry) {
    return entry.first == leak && entry.second == 0.0;
  });
}

std::vector<std::string> confounded(const Campaign& campaign) {
  std::vector<std::string> result;
  add_confounded(
      campaign, "specimen", [](const Condition& c) { return c.specimen; }, result);
  add_confounded(
      campaign, "date", [](const Condition& c) { return c.date; }, result);
  add_confounded(
      campaign, "temperature",
      [](const Condition& c) -> std::optional<std::string> {
        if (!c.temperature_k) return std::nullopt;
        return fmt::format("{:.4g} K", *c.temperature_k);
      },
      result);
  return result;
}

std::vector<std::string> obstacles(const Campaign& campaign, bool has_fit) {
  const auto conditions = diagnosed_conditions(campaign);
  if (conditions.empty())
    return {"no condition is to be diagnosed: expected one whose use is not \"ignore\""};
  Reasons reasons;
  std::set<std::string> hindered;
  for (const Condition* condition : conditions) {
    for (const std::string& reason : lacks_for_diagnosis(campaign, *condition)) {
      reasons.add(reason, condition->id);
      hindered.insert(condition->id);
    }
  }
  if (has_fit && hindered.size() < conditions.size()) return {};
  std::vector<std::string> result = reasons.in_words(conditions.size());
  if (!has_fit) {
    result.emplace_back(
        "the healthy rig is unknown: expected --fit with the fit.json of a fit to "
        "healthy records");
  }
  for (const std::string& each : confounded(campaign)) result.push_back(each);
  return result;
}

}  // namespace rigcal::diagnosis
