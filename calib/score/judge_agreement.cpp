#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calib/score/judge_limits.hpp"
#include "calib/score/judges.hpp"
#include "datasets/checks/sensor_doubts.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;

/// If there are no limits, an agreement below this value is reported. By any standard, a model that
/// explains less than nine tenths of the variance does not describe a record.
constexpr double kPoorRho2 = 0.9;

std::string rho2_text(double rho2) {
  return metrics::score_text(*metrics::find_metric("rho2"), rho2, kPoorRho2);
}

/// Reports limits in the campaign that apply to no scored condition.
void judge_unused_limits(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  const auto by_campaign = [&](const ConditionScore& score) {
    const datasets::Condition* condition = campaign.find(score.id);
    return condition != nullptr && !condition->acceptance && !score.failure && !score.not_scored;
  };
  if (std::none_of(fit.conditions.begin(), fit.conditions.end(), by_campaign)) return;
  for (const datasets::AcceptanceLimit& limit : campaign.acceptance) {
    const bool used =
        std::any_of(fit.conditions.begin(), fit.conditions.end(), [&](const auto& score) {
          return by_campaign(score) &&
                 std::any_of(
                     score.limit_checks.begin(), score.limit_checks.end(), [&](const auto& check) {
                       return check.channel == limit.channel && check.metric == limit.metric;
                     });
        });
    if (used) continue;
    const auto key = datasets::info(limit.channel).key;
    reasons.push_back(reason(AspectState::fail, "limit_not_evaluable",
                             fmt::format("the limit of {} of {} was not evaluated: no condition "
                                         "recorded {}",
                                         limit.metric, key, key)));
  }
}

/// Reports doubtful recordings.
void judge_recordings(const Fit& fit, std::vector<Reason>& reasons) {
  const ConditionScore* first = nullptr;
  std::size_t count = 0;
  for (const ConditionScore& score : fit.conditions) {
    if (score.warnings.empty()) continue;
    ++count;
    if (first == nullptr) first = &score;
  }
  if (first == nullptr) return;
  reasons.push_back(reason(AspectState::reservation, "recording_doubtful",
                           fmt::format("recordings of {} are doubtful; {}: {}",
                                       conditions_text(count), first->id, first->warnings.front()),
                           first->id, {{"conditions", static_cast<double>(count)}}));
}

/// Conditions in which an output channel has no limit.
struct WithoutLimit {
  std::size_t conditions = 0;
  /// The one with the lowest rho2, or the first if there is no rho2.
  const ConditionScore* worst = nullptr;
  double rho2 = std::numeric_limits<double>::infinity();
};

/// Reports compared channels that have no limit.
void judge_without_limits(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  std::map<std::pair<datasets::Channel, bool>, WithoutLimit> found;
  for (const ConditionScore& score : fit.conditions) {
    const datasets::Condition* condition = campaign.find(score.id);
    if (condition == nullptr || score.failure) continue;
    for (const ChannelScore& channel : score.channels) {
      if (score.verdict_of(channel.channel)) continue;
      const bool stated = campaign.may_lack_limits(*condition, channel.channel);
      WithoutLimit& each = found[{channel.channel, stated}];
      ++each.conditions;
      const double rho2 = std::isnan(channel.metrics.rho2) ? std::numeric_limits<double>::infinity()
                                                           : channel.metrics.rho2;
      if (each.worst != nullptr && rho2 >= each.rho2) continue;
      each.worst = &score;
      each.rho2 = rho2;
    }
  }
  for (const auto& [key, each] : found) {
    const auto& [channel, stated] = key;
    const auto name = datasets::info(channel).key;
    const bool scored = std::isfinite(each.rho2);
    std::vector<std::pair<std::string, double>> numbers{
        {"conditions", static_cast<double>(each.conditions)}};
    if (scored) numbers.emplace_back("rho2", each.rho2);
    const std::string where = fmt::format(
        "{} ({} in {})", conditions_text(each.conditions),
        scored ? "lowest rho2 " + rho2_text(each.rho2) : "no rho2 exists", each.worst->id);
    reasons.push_back(
        stated
            ? reason(AspectState::note, "not_judged_as_stated",
                     fmt::format("{} is not judged in {}, as `not_judged` specifies", name, where),
                     each.worst->id, numbers)
            : reason(AspectState::reservation, "not_judged",
                     fmt::format("no limit applies to {} in {}, which the fit uses: "
                                 "expected limits in [acceptance.{}], or not_judged = [\"{}\"]",
                                 name, where, name, name),
                     each.worst->id, numbers));
  }
}

/// Reports doubts about the sensors that [report] lists.
void judge_sensors(const Campaign& campaign, std::vector<Reason>& reasons) {
  for (const datasets::SensorDoubt& doubt : datasets::sensor_doubts(campaign))
    reasons.push_back(reason(doubt.grave ? AspectState::reservation : AspectState::note, doubt.code,
                             doubt.words));
}

/// Reports the lowest rho2 of all signals. Used for campaigns without limits.
void name_poor_agreement(const Fit& fit, std::vector<Reason>& reasons) {
  const ConditionScore* where = nullptr;
  const ChannelScore* worst = nullptr;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      if (std::isnan(channel.metrics.rho2)) continue;
      if (worst != nullptr && channel.metrics.rho2 >= worst->metrics.rho2) continue;
      worst = &channel;
      where = &score;
    }
  }
  if (worst == nullptr) return;
  const double rho2 = worst->metrics.rho2;
  const bool poor = rho2 < kPoorRho2;
  reasons.push_back(reason(AspectState::not_assessed, poor ? "poor_agreement" : "least_agreement",
                           fmt::format("least agreement: rho2 = {} of {} in {}{}", rho2_text(rho2),
                                       datasets::info(worst->channel).key, where->id,
                                       poor ? ": the model does not describe this record" : ""),
                           where->id, {{"rho2", rho2}}));
}

/// Notes the predictions that the uncertainty of the estimates alone may take beyond their limit of
/// rho2, although the model is right.
void note_open_predictions(const ConditionScore& score, std::vector<Reason>& reasons) {
  for (const LimitCheck& check : score.limit_checks) {
    const auto open = score.open.find(check.channel);
    if (check.metric != "rho2" || !check.limit || open == score.open.end()) continue;
    const double expected = 1.0 - open->second.variance_fraction;
    if (expected >= *check.limit) continue;
    const std::vector<std::string>& through = open->second.through;
    reasons.push_back(reason(
        AspectState::note, "prediction_open",
        fmt::format(
            "{}: the fitted records do not determine the prediction of {}: if the model is "
            "right, an rho2 {} is expected (limit {}){}",
            score.id, datasets::info(check.channel).key,
            expected < 0.0 ? "below 0" : fmt::format("of {:.2g}", expected), *check.limit,
            through.empty() ? "" : fmt::format(", mainly due to {}", fmt::join(through, ", "))),
        score.id, {{"rho2", expected}, {"limit", *check.limit}}));
  }
}

}  // namespace

Aspect judge_agreement(const Campaign& campaign, const Fit& fit) {
  std::vector<Reason> reasons;
  if (!has_limits(campaign, fit)) {
    reasons.push_back(no_limits());
    name_poor_agreement(fit, reasons);
    return aspect_of(std::move(reasons));
  }
  std::vector<const ConditionScore*> scores;
  for (const ConditionScore& score : fit.conditions) scores.push_back(&score);
  judge_limits(scores, reasons);
  judge_unused_limits(campaign, fit, reasons);
  judge_recordings(fit, reasons);
  if (reasons.empty()) {
    reasons.push_back(
        reason(AspectState::not_assessed, "not_scored",
               scores.empty() ? "no condition was scored" : "no scored condition has a limit"));
  }
  judge_without_limits(campaign, fit, reasons);
  judge_sensors(campaign, reasons);
  return aspect_of(std::move(reasons));
}

Aspect judge_validation(const datasets::Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from) {
  std::vector<Reason> reasons;
  std::vector<const ConditionScore*> independent;
  for (const ConditionScore& score : fit.conditions) {
    if (!estimated_from.contains(score.id)) independent.push_back(&score);
  }
  if (independent.empty()) {
    std::string words =
        "not assessed: every condition with a score was also used to estimate the values";
    if (fit.cross_validation)
      words += "; see the cross-validation, which leaves out one after the other";
    reasons.push_back(
        reason(AspectState::not_assessed, "no_validation", words, {}, {{"conditions", 0.0}}));
  } else if (!has_limits(campaign, fit)) {
    reasons.push_back(no_limits());
  } else {
    judge_limits(independent, reasons);
    if (reasons.empty()) {
      reasons.push_back(reason(AspectState::not_assessed, "not_scored",
                               "no condition of the validation has a limit"));
    }
    for (const ConditionScore* score : independent) note_open_predictions(*score, reasons);
  }
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
