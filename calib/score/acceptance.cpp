#include "calib/score/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/significant.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

const metrics::MetricSpec& metric(std::string_view name) {
  const metrics::MetricSpec* found = metrics::find_metric(name);
  if (found == nullptr)
    throw std::invalid_argument(fmt::format("judge: no metric is named '{}'", name));
  return *found;
}

/// Returns the best value of a metric that the noise allows for any model; absent if the noise is
/// unknown.
std::optional<double> floor_of(const ChannelScore& score, std::string_view name) {
  if (!score.noise_floor) return std::nullopt;
  if (name == "rho2") return score.noise_floor->rho2;
  if (name == "ccc") return score.noise_floor->ccc;
  if (name == "absolute_error_percent") return score.noise_floor->absolute_error_percent;
  return std::nullopt;
}

/// Returns the distance of a value from the ideal, divided by the distance of the bound from the
/// ideal. Infinite if the bound is ideal and the value is not.
double used_of(const metrics::MetricSpec& spec, double value, double bound) {
  const double distance = std::abs(value - metrics::ideal(spec));
  const double allowed = std::abs(bound - metrics::ideal(spec));
  if (distance == 0.0) return 0.0;
  return distance / allowed;
}

/// Returns true if a score must keep its limit by more than its expanded uncertainty.
bool counts_uncertainty(datasets::DecisionRule rule) {
  switch (rule) {
    case datasets::DecisionRule::simple:
      return false;
    case datasets::DecisionRule::guard_band:
      break;
  }
  return true;
}

LimitCheck check(const datasets::AcceptanceLimit& limit, datasets::DecisionRule rule,
                 const ChannelScore& channel) {
  LimitCheck result;
  result.channel = channel.channel;
  result.metric = limit.metric;
  result.limit = limit.limit;
  result.warn = limit.warn;
  const auto key = datasets::info(channel.channel).key;
  const metrics::MetricSpec& spec = metric(limit.metric);
  const double value = channel.metrics.*spec.value;
  if (std::isnan(value)) {
    result.verdict = Verdict::fail;
    result.words = fmt::format("{}: {} does not exist, so that its limit cannot be evaluated ({})",
                               key, limit.metric, channel.metrics.problem.value_or(""));
    return result;
  }
  result.value = value;
  result.tolerance_used = 0.0;
  if (channel.expanded_uncertainty)
    result.expanded_uncertainty = (*channel.expanded_uncertainty).*spec.value;
  const auto beyond = [&](const std::optional<double>& bound) {
    return bound && !metrics::keeps(spec, value, *bound);
  };
  const auto text = [&](double bound) {
    std::string note;
    const auto floor = floor_of(channel, limit.metric);
    if (floor && !metrics::keeps(spec, *floor, bound))
      note = fmt::format("; the noise of the record allows {} at best",
                         metrics::score_text(spec, *floor, bound));
    return fmt::format("{}: {} = {} is {} {:.6g}{}", key, limit.metric,
                       metrics::score_text(spec, value, bound),
                       spec.higher_is_better ? "below" : "above", bound, note);
  };
  if (beyond(limit.limit)) {
    result.verdict = Verdict::fail;
    result.words = text(*limit.limit);
  } else if (beyond(limit.warn)) {
    result.verdict = Verdict::warn;
    result.words = text(*limit.warn);
  } else if (limit.limit && counts_uncertainty(rule)) {
    const auto& uncertainty = result.expanded_uncertainty;
    const double worse = spec.higher_is_better ? -1.0 : 1.0;
    result.in_guard_band =
        !uncertainty || !metrics::keeps(spec, value + worse * *uncertainty, *limit.limit);
    if (result.in_guard_band) {
      result.verdict = Verdict::warn;
      result.words = fmt::format(
          "{}: {} = {} keeps {:.6g}, but {}", key, limit.metric,
          metrics::score_text(spec, value, *limit.limit), *limit.limit,
          uncertainty
              ? "not by more than its expanded uncertainty of " + significant(*uncertainty, 2)
              : std::string(
                    "its uncertainty is unknown: that needs at least two repeats that differ"));
    }
  }
  if (const auto bound = limit.limit ? limit.limit : limit.warn)
    result.tolerance_used = used_of(spec, value, *bound);
  return result;
}

}  // namespace

void judge(const std::vector<datasets::AcceptanceLimit>& limits, datasets::DecisionRule rule,
           ConditionScore& score) {
  if (limits.empty()) return;
  if (score.failure) {
    score.verdict = Verdict::fail;
    score.reasons.push_back("could not be simulated: " + *score.failure);
    return;
  }
  std::map<datasets::Channel, Verdict> worst;
  for (const datasets::AcceptanceLimit& limit : limits) {
    for (const ChannelScore& channel : score.channels) {
      if (channel.channel != limit.channel) continue;
      score.limit_checks.push_back(check(limit, rule, channel));
      const LimitCheck& made = score.limit_checks.back();
      Verdict& of_channel = worst.try_emplace(channel.channel, Verdict::pass).first->second;
      of_channel = std::max(of_channel, made.verdict);
      score.verdict = std::max(score.verdict.value_or(Verdict::pass), made.verdict);
      if (!made.words.empty()) score.reasons.push_back(made.words);
    }
  }
  score.channel_verdicts.assign(worst.begin(), worst.end());
}

std::string_view words_of(datasets::DecisionRule rule) {
  switch (rule) {
    case datasets::DecisionRule::simple:
      return "simple acceptance";
    case datasets::DecisionRule::guard_band:
      return "guard band";
  }
  throw std::logic_error("words_of: no words for a decision rule");
}

std::string tolerance_used_text(double used) {
  constexpr int kMostDigits = 6;
  if (used > 10.0) return "over 1000 %";
  std::string text = significant(100.0 * used, 2);
  // Close to 100 %, more digits show on which side of the limit the value is.
  for (int digits = 3; text == "100" && used != 1.0 && digits <= kMostDigits; ++digits)
    text = significant(100.0 * used, digits);
  if (used < 1.0 && text.starts_with("100")) return "just below 100 %";
  return text + " %";
}

}  // namespace rigcal::calib
