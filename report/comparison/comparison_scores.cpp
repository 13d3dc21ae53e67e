#include <algorithm>
#include <array>

#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

struct ComparedMetric {
  const char* name;
  std::optional<double> StoredComparedScore::*value;
  bool higher_is_better = true;
};
constexpr std::array kComparedMetrics{
    ComparedMetric{"rho2", &StoredComparedScore::rho2},
    ComparedMetric{"ccc", &StoredComparedScore::ccc},
    ComparedMetric{"absolute_error_percent", &StoredComparedScore::absolute_error_percent, false}};

std::optional<StoredComparedScore> score_of(const StoredFit& fit, const std::string& id,
                                            const std::string& channel) {
  const calib::ConditionResult* condition = fit.find(id);
  if (condition == nullptr) return std::nullopt;
  StoredComparedScore score;
  score.use = condition->use;
  score.samples = condition->samples;
  score.date = condition->date;
  score.temperature_k = condition->temperature_k;
  score.verdict = condition->verdict_of(channel);
  score.failure = condition->failure;
  const calib::ChannelScore* found = condition->find(channel);
  if (found == nullptr || !is_usable(fit)) return score;
  score.rho2 = finite(found->metrics.rho2);
  score.ccc = finite(found->metrics.ccc);
  score.absolute_error_percent = finite(found->metrics.absolute_error_percent);
  return score;
}

std::optional<calib::ScoreDifference> metric_against(
    const std::vector<StoredComparedCondition>& conditions, const std::string& channel,
    const ComparedMetric& metric, std::size_t other, bool shared) {
  std::vector<std::pair<double, double>> pairs;
  for (const StoredComparedCondition& condition : conditions) {
    const auto& scores = condition.scores;
    if (condition.channel != channel || !scores[0] || !scores[other]) continue;
    const auto& a = (*scores[0]).*metric.value;
    const auto& b = (*scores[other]).*metric.value;
    if (a && b) pairs.emplace_back(*a, *b);
  }
  if (pairs.empty()) return std::nullopt;
  return calib::score_difference(pairs, metric.higher_is_better, shared);
}

}  // namespace

std::vector<StoredComparedCondition> compared_conditions(const std::vector<Compared>& results) {
  std::vector<StoredComparedCondition> list;
  for (const Compared& compared : results) {
    for (const calib::ConditionResult& condition : compared.result.conditions) {
      for (const calib::ChannelScore& score : condition.channels) {
        const bool there = std::any_of(list.begin(), list.end(), [&](const auto& e) {
          return e.id == condition.id && e.channel == score.key();
        });
        if (there) continue;
        // The description is taken from the first result that has the condition.
        const auto first = std::find_if(results.begin(), results.end(), [&](const Compared& each) {
          return each.result.find(condition.id) != nullptr;
        });
        const calib::ConditionResult& described = *first->result.find(condition.id);
        list.push_back({condition.id,
                        std::string(score.key()),
                        described.waveform,
                        described.frequency_hz,
                        described.leak_level,
                        {}});
      }
    }
  }
  for (StoredComparedCondition& condition : list) {
    for (const Compared& compared : results)
      condition.scores.push_back(score_of(compared.result, condition.id, condition.channel));
  }
  return list;
}

std::vector<StoredComparedMetric> compared_metrics(
    const std::vector<StoredComparedCondition>& conditions, const std::vector<Compared>& results) {
  std::vector<std::string> channels;
  for (const StoredComparedCondition& condition : conditions) {
    if (std::find(channels.begin(), channels.end(), condition.channel) == channels.end())
      channels.push_back(condition.channel);
  }
  std::vector<StoredComparedMetric> list;
  for (const std::string& channel : channels) {
    for (const ComparedMetric& metric : kComparedMetrics) {
      StoredComparedMetric& entry =
          list.emplace_back(StoredComparedMetric{channel, metric.name, {}});
      entry.against_first.emplace_back();
      for (std::size_t i = 1; i < results.size(); ++i)
        entry.against_first.push_back(
            metric_against(conditions, channel, metric, i, share_records(results[0], results[i])));
    }
  }
  return list;
}

}  // namespace rigcal::report
