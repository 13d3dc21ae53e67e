#include "calib/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

const metrics::MetricSpec& metric(std::string_view name) {
  const auto found = std::find_if(metrics::kMetrics.begin(), metrics::kMetrics.end(),
                                  [name](const auto& spec) { return spec.name == name; });
  if (found == metrics::kMetrics.end())
    throw std::invalid_argument(fmt::format("judge: no metric is named '{}'", name));
  return *found;
}

/// What the noise of the record leaves of a metric to any model; empty where that is not known.
std::optional<double> floor_of(const ChannelScore& score, std::string_view name) {
  if (!score.noise_floor) return std::nullopt;
  if (name == "rho2") return score.noise_floor->rho2;
  if (name == "ccc") return score.noise_floor->ccc;
  if (name == "absolute_error_percent") return score.noise_floor->absolute_error_percent;
  return std::nullopt;
}

void lower_verdict(ConditionScore& score, Verdict verdict, std::string reason) {
  score.verdict = std::max(score.verdict.value_or(Verdict::pass), verdict);
  score.reasons.push_back(std::move(reason));
}

void judge_metric(const datasets::AcceptanceLimit& limit, const ChannelScore& channel,
                  ConditionScore& score) {
  const auto key = datasets::info(channel.channel).key;
  if (!score.verdict) score.verdict = Verdict::pass;
  if (!channel.agreement) {
    lower_verdict(score, Verdict::warn,
                  fmt::format("{}: {} does not exist ({})", key, limit.metric, channel.problem));
    return;
  }
  const metrics::MetricSpec& spec = metric(limit.metric);
  const double value = (*channel.agreement).*spec.value;
  const auto beyond = [&](const std::optional<double>& bound) {
    return bound && !(spec.higher_is_better ? value >= *bound : value <= *bound);
  };
  const auto text = [&](double bound) {
    std::string note;
    const auto floor = floor_of(channel, limit.metric);
    if (floor && (spec.higher_is_better ? *floor < bound : *floor > bound))
      note = fmt::format("; the noise of the record allows {:.6g} at best", *floor);
    return fmt::format("{}: {} = {:.6g} is {} {:.6g}{}", key, limit.metric, value,
                       spec.higher_is_better ? "below" : "above", bound, note);
  };
  if (beyond(limit.limit)) {
    lower_verdict(score, Verdict::fail, text(*limit.limit));
  } else if (beyond(limit.warn)) {
    lower_verdict(score, Verdict::warn, text(*limit.warn));
  }
}

}  // namespace

void judge(const std::vector<datasets::AcceptanceLimit>& limits, ConditionScore& score) {
  if (limits.empty()) return;
  if (!score.failure.empty()) {
    lower_verdict(score, Verdict::fail, "could not be simulated: " + score.failure);
    return;
  }
  for (const datasets::AcceptanceLimit& limit : limits) {
    for (const ChannelScore& channel : score.channels) {
      if (channel.channel == limit.channel) judge_metric(limit, channel, score);
    }
  }
}

std::optional<Verdict> worst(const std::vector<ConditionScore>& scores) {
  std::optional<Verdict> result;
  for (const ConditionScore& score : scores) {
    if (score.verdict) result = std::max(result.value_or(Verdict::pass), *score.verdict);
  }
  return result;
}

}  // namespace rigcal::calib
