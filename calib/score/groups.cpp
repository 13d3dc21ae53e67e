#include "calib/score/groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace rigcal::calib {
namespace {

using datasets::Condition;
using Label = std::function<std::optional<std::string>(const Condition&)>;

/// Returns the score of a channel. If there is none, an empty one is added first.
GroupScore& score_in(Group& group, datasets::Channel channel) {
  auto& all = group.metrics;
  const auto place =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.first >= channel; });
  if (place != all.end() && place->first == channel) return place->second;
  return all.insert(place, {channel, GroupScore{}})->second;
}

void add_score(GroupScore& score, const metrics::Agreement& agreement) {
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    const double value = agreement.*metric.value;
    double& mean = score.mean.*metric.value;
    double& worst = score.worst.*metric.value;
    mean += (value - mean) / (score.conditions + 1);
    if (score.conditions == 0) {
      worst = value;
    } else {
      worst = metric.higher_is_better ? std::min(worst, value) : std::max(worst, value);
    }
  }
  ++score.conditions;
}

void gather(std::vector<Group>& result, const std::string& by, const Label& label,
            const std::vector<std::pair<const Condition*, const ConditionScore*>>& scores) {
  const std::size_t first = result.size();
  for (const auto& [condition, score] : scores) {
    const std::optional<std::string> text = label(*condition);
    if (!text) continue;
    const auto begin = result.begin() + static_cast<std::ptrdiff_t>(first);
    auto group =
        std::find_if(begin, result.end(), [&](const Group& g) { return g.label == *text; });
    if (group == result.end()) group = result.insert(group, Group{by, *text, {}, {}});
    group->conditions.push_back(condition->id);
    for (const ChannelScore& channel : score->channels) {
      if (!std::isnan(channel.metrics.rho2))
        add_score(score_in(*group, channel.channel), channel.metrics);
    }
  }
}

}  // namespace

std::vector<Group> groups(const datasets::Campaign& campaign, const Fit& fit) {
  std::vector<std::pair<const Condition*, const ConditionScore*>> scores;
  for (const ConditionScore& score : fit.conditions) {
    if (const Condition* condition = campaign.find(score.id))
      scores.emplace_back(condition, &score);
  }
  auto by_frequency = scores;
  std::stable_sort(by_frequency.begin(), by_frequency.end(), [](const auto& a, const auto& b) {
    return a.first->frequency_hz.value_or(0.0) < b.first->frequency_hz.value_or(0.0);
  });

  std::vector<Group> result;
  gather(
      result, "use", [](const Condition& c) { return std::string(to_string(c.use)); }, scores);
  const auto frequency = [](const Condition& c) -> std::optional<std::string> {
    if (!c.frequency_hz) return std::nullopt;
    return fmt::format("{:.6g} Hz", *c.frequency_hz);
  };
  const auto signal = [&](const Condition& c) -> std::optional<std::string> {
    if (!c.frequency_hz) return std::nullopt;
    return fmt::format("{} {}", to_string(c.waveform), *frequency(c));
  };
  gather(result, "signal", signal, by_frequency);
  gather(result, "frequency", frequency, by_frequency);
  gather(
      result, "waveform", [](const Condition& c) { return std::string(to_string(c.waveform)); },
      scores);
  gather(
      result, "leak_level", [](const Condition& c) { return c.leak_level; }, scores);
  return result;
}

}  // namespace rigcal::calib
