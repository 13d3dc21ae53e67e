#include "calib/result/condition_score.hpp"

#include <algorithm>

namespace rigcal::calib {

const metrics::Agreement* ChannelScore::printed_uncertainty() const {
  const auto& known = two_sided_uncertainty ? two_sided_uncertainty : expanded_uncertainty;
  return known ? &*known : nullptr;
}

std::optional<Verdict> ConditionResult::verdict_of(datasets::Channel channel) const {
  if (failure) return verdict;
  for (const auto& [judged, worst] : channel_verdicts)
    if (judged == channel) return worst;
  return std::nullopt;
}

std::optional<Verdict> ConditionResult::verdict_of(std::string_view key) const {
  if (failure) return verdict;
  const auto channel = datasets::channel_from_key(key);
  return channel ? verdict_of(*channel) : std::nullopt;
}

const ChannelScore* ConditionResult::find(std::string_view key) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const ChannelScore& each) { return each.key() == key; });
  return found == channels.end() ? nullptr : &*found;
}

}  // namespace rigcal::calib
