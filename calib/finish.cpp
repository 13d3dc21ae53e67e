#include "calib/finish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "calib/score/assessment.hpp"
#include "calib/score/scorecard.hpp"
#include "calib/score/validity.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "datasets/checks/record_warnings.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::Record;
using datasets::Use;

/// Adds a lack-of-fit test for every scored condition that was not fitted.
void add_predictions(Fit& fit) {
  std::vector<LackOfFit> predictions;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      if (channel.lack_of_fit && !fit.lack_of_fit->has(score.id, channel.channel))
        predictions.push_back(*channel.lack_of_fit);
    }
  }
  judge_together(predictions);
  auto& tests = fit.lack_of_fit->tests;
  tests.insert(tests.end(), predictions.begin(), predictions.end());
}

/// Returns the conditions from which the campaign's values are assumed to have been estimated.
std::set<std::string> fitted_conditions(const Campaign& campaign) {
  std::set<std::string> ids;
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == Use::fit) ids.insert(condition.id);
  }
  return ids;
}

/// Adds the campaign's statements about a condition.
void add_stated(const Campaign& campaign, ConditionScore& score) {
  const Condition* condition = campaign.find(score.id);
  if (condition == nullptr) return;
  score.waveform = std::optional(condition->waveform);
  score.frequency_hz = condition->frequency_hz;
  put_amplitude(info(drive_channel(campaign)).unit, condition->amplitude, score);
  score.leak_level = condition->leak_level;
  score.temperature_k = condition->temperature_k;
  score.date = condition->date;
  score.acceptance = condition->acceptance;
  if (!condition->not_judged.empty()) score.not_judged = condition->not_judged;
}

/// Adds what campaign and records state about the conditions. Warnings about the recordings are
/// also warnings of the fit, where conditions with the same warning are combined.
void add_stated(const Campaign& campaign, const std::vector<Record>& records, Fit& fit) {
  std::vector<const Record*> used;
  for (ConditionScore& score : fit.conditions) {
    add_stated(campaign, score);
    const auto record = std::find_if(records.begin(), records.end(), [&](const Record& each) {
      return each.condition == score.id;
    });
    if (record == records.end()) continue;
    score.windows_s.emplace();
    for (const datasets::TimeWindow& window : record->windows)
      score.windows_s->push_back({window.start_s, window.end_s});
    score.notes = record->notes;
    score.warnings = record->warnings;
    used.push_back(&*record);
  }
  for (const auto& each : datasets::gathered_warnings(used))
    fit.warnings.push_back(each.with_conditions());
}

}  // namespace

void finish(const Campaign& campaign, const std::vector<Record>& records,
            Budget::Clock::time_point began, const Origin* origin, Fit& fit) {
  std::stable_sort(fit.conditions.begin(), fit.conditions.end(), [&](const auto& a, const auto& b) {
    return campaign.find(a.id) < campaign.find(b.id);
  });
  add_predictions(fit);
  add_stated(campaign, records, fit);
  fit.assessment = assess(campaign, fit,
                          origin != nullptr ? origin->estimated_from : fitted_conditions(campaign),
                          origin != nullptr ? &origin->parameters : nullptr);
  fit.verdict = verdict_of(fit.assessment);
  const auto words = overfitting_warnings(fit.conditions);
  fit.warnings.insert(fit.warnings.end(), words.begin(), words.end());
  for (const ConditionScore& score : fit.conditions) {
    if (score.failure) {
      fit.warnings.push_back(
          fmt::format("condition \"{}\" could not be simulated: {}", score.id, *score.failure));
    }
  }
  fit.wall_seconds = std::chrono::duration<double>(Budget::Clock::now() - began).count();
}

}  // namespace rigcal::calib
