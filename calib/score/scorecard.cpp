#include "calib/score/scorecard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/consider/effect_changes.hpp"
#include "calib/problem/day_effects.hpp"
#include "calib/score/acceptance.hpp"
#include "calib/search/late_flag.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "common/parallel.hpp"
#include "metrics/agreement_uncertainty.hpp"
#include "metrics/distributions.hpp"
#include "metrics/fundamental.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

using datasets::Condition;

/// Why a condition has no score after the user ended the job.
constexpr const char* kStopped = "stopped on request";

/// Finds the longest run of consecutive samples that count, and returns its first index and its
/// length.
std::pair<std::size_t, std::size_t> longest_stretch(const std::vector<std::size_t>& rows) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i] != rows[i - 1] + 1) begin = i;
    if (i + 1 - begin > best.second) best = {begin, i + 1 - begin};
  }
  return best;
}

void add_problem(ChannelMetrics& metrics, const std::string& text) {
  metrics.problem = metrics.problem ? *metrics.problem + "; " + text : text;
}

void compare_at_fundamental(const ProblemCondition& condition, std::span<const double> measured,
                            std::span<const double> simulated, ChannelMetrics& result) {
  const Condition& c = *condition.condition;
  if (!is_periodic(c.waveform) || !c.frequency_hz) return;
  const auto [first, count] = longest_stretch(condition.rows);
  const auto time_s = std::span(condition.record->time_s).subspan(condition.rows[first], count);
  try {
    const auto found = metrics::compare_fundamentals(
        time_s, measured.subspan(first, count), simulated.subspan(first, count), *c.frequency_hz);
    result.gain_ratio = found.gain_ratio;
    result.phase_deg = found.phase_deg;
    result.delay_s = found.delay_s;
  } catch (const std::logic_error& error) {  // no whole period, or no component at that frequency
    add_problem(result, error.what());
  }
}

/// Tests the residual of the k-th channel over the longest run of samples without a gap, and
/// replaces its tests and curves in the score. They are absent if it cannot be tested.
void test_residual(const ProblemCondition& condition, std::size_t k,
                   std::span<const double> simulated, ConditionScore& score) {
  const std::vector<double>& measured = condition.channels[k].measured;
  std::optional<metrics::ResidualTests>& tests = score.channels[k].residual_tests;
  score.residual_curves.resize(score.channels.size());
  auto& [channel, curves] = score.residual_curves[k];
  channel = condition.channels[k].channel;
  tests.reset();
  curves.reset();
  const auto [first, count] = longest_stretch(condition.rows);
  if (count < 2) return;
  std::vector<double> residual;
  for (std::size_t i = first; i < first + count; ++i)
    residual.push_back(measured[i] - simulated[i]);
  const auto& time_s = condition.record->time_s;
  const std::size_t begin = condition.rows[first];
  const double interval_s =
      (time_s[begin + count - 1] - time_s[begin]) / static_cast<double>(count - 1);
  try {
    metrics::TestedResidual tested =
        metrics::residual_tests(residual, std::span(score.drive).subspan(begin, count), interval_s);
    curves = std::move(tested.curves);
    tests = std::move(tested);
  } catch (const std::logic_error&) {  // residual too short or constant
    return;
  }
}

/// Returns the averaged channel with its uncertainty, at the samples inside the windows.
metrics::MeasuredMean measured_mean(const datasets::Campaign& campaign,
                                    const ProblemCondition& condition,
                                    const ProblemChannel& channel) {
  metrics::MeasuredMean result{channel.measured, {}};
  for (const auto& whole : condition.record->channels.at(channel.channel).deviations) {
    std::vector<double>& own = result.deviations.emplace_back();
    own.reserve(condition.rows.size());
    for (const std::size_t row : condition.rows) own.push_back(whole[row]);
  }
  if (const auto found = campaign.channels.find(channel.channel);
      found != campaign.channels.end()) {
    result.gain_sd = found->second.gain_sd;
    result.offset_sd = found->second.offset_sd;
  }
  return result;
}

/// Returns the uncertainty budget of each score, in the order of the metrics. A score has no shift,
/// because the effects of a sensor change it by as much in either direction.
///
/// @param effects  effects of the sensor, one per item of MeasuredMean::changes
Keyed<Budget95> budgets_of(datasets::Channel channel, const metrics::MeasuredMean& mean,
                           const metrics::ScoreUncertainty& found,
                           const std::vector<SensorChange>& effects) {
  const metrics::ScoreContributions& parts = found.contributions;
  const std::string_view key = datasets::info(channel).key;
  Keyed<Budget95> budgets;
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    const auto score = metric.value;
    Budget95 budget;
    budget.lines = {{"repeats", "records", parts.repeats.*score},
                    {"noise_left", "records", parts.noise_left.*score}};
    const auto add_stated = [&](const char* what, double sd, double uncertainty) {
      if (sd > 0.0)
        budget.lines.push_back({certificate_name(what, key), "known_value", uncertainty});
    };
    add_stated("gain", mean.gain_sd, parts.gain.*score);
    add_stated("offset", mean.offset_sd, parts.offset.*score);
    for (std::size_t i = 0; i < effects.size(); ++i)
      budget.lines.push_back({effects[i].key, "effect", parts.changes[i].*score});
    budget.degrees_of_freedom = parts.degrees_of_freedom.*score;
    budget.coverage_factor = parts.coverage_factor.*score;
    budget.expanded = found.two_sided.*score;
    budget.combined = budget.expanded / budget.coverage_factor;
    budgets.emplace_back(metric.name, std::move(budget));
  }
  return budgets;
}

/// Effects that a fit considered, and those of them that act in a problem.
struct ScoredEffects {
  const EffectCovariance& covariance;
  std::vector<Effect> acting;
};

ChannelScore score_channel(const datasets::Campaign& campaign, const ProblemCondition& condition,
                           const ProblemChannel& channel, const std::vector<double>& simulated,
                           const ScoredEffects& effects) {
  ChannelScore score;
  score.channel = channel.channel;
  try {
    score.metrics = metrics::agreement(channel.measured, simulated);
    metrics::MeasuredMean mean = measured_mean(campaign, condition, channel);
    std::vector<double> times_s;
    for (const std::size_t row : condition.rows) times_s.push_back(condition.record->time_s[row]);
    const std::vector<SensorChange> changes =
        sensor_changes(channel.channel, effects.acting, effects.covariance, simulated, times_s);
    for (const SensorChange& each : changes) mean.changes.push_back(each.change);
    if (const auto found = metrics::agreement_uncertainty(mean, simulated)) {
      score.expanded_uncertainty = found->one_sided;
      score.two_sided_uncertainty = found->two_sided;
      score.score_budgets = budgets_of(channel.channel, mean, *found, changes);
    }
  } catch (const std::logic_error& error) {  // constant channel, or fewer than two samples
    add_problem(score.metrics, error.what());
  }
  if (channel.sd_known) {
    try {
      score.noise_floor = metrics::noise_floor(channel.measured, channel.sd);
    } catch (const std::logic_error& error) {
      add_problem(score.metrics, error.what());
    }
  }
  compare_at_fundamental(condition, channel.measured, simulated, score.metrics);
  std::vector<double> residual;
  for (std::size_t i = 0; i < simulated.size(); ++i)
    residual.push_back(channel.measured[i] - simulated[i]);
  score.lack_of_fit = lack_of_prediction(condition, channel, residual);
  return score;
}

ConditionScore score_condition(const Problem& problem, std::size_t i, std::span<const double> z,
                               const ScoredEffects& effects) {
  const ProblemCondition& condition = problem.conditions[i];
  ConditionScore score;
  score.id = condition.condition->id;
  score.use = condition.condition->use;
  score.samples = static_cast<long>(condition.rows.size());
  score.time_s = condition.record->time_s;
  if (condition.rows.size() < score.time_s.size()) {
    score.in_window.assign(score.time_s.size(), false);
    for (const std::size_t row : condition.rows) score.in_window[row] = true;
  }
  for (const double t : score.time_s) score.drive.push_back(condition.inputs.drive.value(t));
  std::vector<model::Output> outputs = condition.outputs;
  outputs.push_back(model::Output::servo_flow);
  outputs.push_back(model::Output::leakage_flow);
  model::SimulationOptions options = problem.simulation_options();
  if (condition.measured_tolerance > 0.0) options.tolerance = problem.tolerance_of(i);
  const model::Simulation run = model::simulate(condition.rig, problem.values_at(i, z), {},
                                                condition.inputs, score.time_s, outputs, options);
  if (is_raised(options.cancel)) {
    score.not_scored = kStopped;
    for (const ProblemChannel& channel : condition.channels)
      score.series[channel.channel] = {condition.record->channels.at(channel.channel).mean, {}};
    return score;
  }
  if (!run.ok()) {
    score.failure =
        fmt::format("{} at {:g} s ({})", run.reason, run.failed_at_s, model::to_string(run.status));
    for (const ProblemChannel& channel : condition.channels)
      score.series[channel.channel] = {condition.record->channels.at(channel.channel).mean, {}};
  } else {
    const auto column = [&](std::size_t k) {
      const auto values = run.outputs.col(static_cast<Eigen::Index>(k));
      return std::vector<double>(values.begin(), values.end());
    };
    score.servo_flow_m3_per_s = column(outputs.size() - 2);
    score.leakage_flow_m3_per_s = column(outputs.size() - 1);
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      const ProblemChannel& channel = condition.channels[k];
      std::vector<double> whole = column(k);
      std::vector<double> simulated;
      for (const std::size_t row : condition.rows) simulated.push_back(whole[row]);
      score.channels.push_back(
          score_channel(*problem.campaign, condition, channel, simulated, effects));
      test_residual(condition, k, simulated, score);
      score.series[channel.channel] = {condition.record->channels.at(channel.channel).mean,
                                       std::move(whole)};
    }
  }
  judge(problem.campaign->limits(*condition.condition),
        problem.campaign->acceptance_bounds.decision, score);
  return score;
}

/// Returns true if the explained component of a residual is as large as its standard deviation lets
/// expect. Otherwise estimates, effects or days would have to be off by more than their errors and
/// sizes allow. Few directions dominate this component, so that its mean square is compared with
/// the chi-square distribution of one degree of freedom at 1 %, the widest of all.
///
/// @param explained  shape (samples in windows)
/// @param sd         standard deviation of a measurement about the simulation; shape (samples)
bool is_plausible(const ProblemCondition& condition, std::span<const double> explained,
                  std::span<const double> sd, double noise_sd) {
  double squares = 0.0;
  double expected = 0.0;
  for (std::size_t j = 0; j < explained.size(); ++j) {
    squares += explained[j] * explained[j];
    expected += std::pow(sd[condition.rows[j]], 2) - noise_sd * noise_sd;
  }
  return squares <= std::pow(metrics::normal_quantile(0.995), 2) * expected;
}

}  // namespace

std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads, const EffectCovariance& effects) {
  const ScoredEffects scored{effects, considered_in(problem, z, effects)};
  std::vector<ConditionScore> scores(problem.conditions.size());
  parallel_for(scores.size(), threads,
               [&](std::size_t i) { scores[i] = score_condition(problem, i, z, scored); });
  return scores;
}

void test_predictions(const Problem& problem, const std::vector<std::string>& dates,
                      std::vector<ConditionScore>& scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    for (std::size_t k = 0; k < scores[i].channels.size(); ++k) {
      const datasets::Channel channel = condition.channels[k].channel;
      const auto explained = scores[i].explained.find(channel);
      if (explained == scores[i].explained.end()) continue;
      const std::vector<double>& whole = scores[i].series.at(channel).second;
      std::vector<double> simulated;
      for (std::size_t j = 0; j < condition.rows.size(); ++j)
        simulated.push_back(whole[condition.rows[j]] + explained->second[j]);
      test_residual(condition, k, simulated, scores[i]);
      const ProblemChannel& data = condition.channels[k];
      if (!is_of_another_day(*condition.condition, dates) ||
          !is_plausible(condition, explained->second, scores[i].prediction_sd.at(channel), data.sd))
        continue;
      std::vector<double> residual;
      for (std::size_t j = 0; j < simulated.size(); ++j)
        residual.push_back(data.measured[j] - simulated[j]);
      scores[i].channels[k].lack_of_fit = lack_of_prediction(condition, data, residual);
    }
  }
}

std::vector<ConditionScore> unscored_conditions(const Problem& problem, const std::string& why) {
  std::vector<ConditionScore> scores;
  for (const ProblemCondition& condition : problem.conditions) {
    ConditionScore& score = scores.emplace_back();
    score.id = condition.condition->id;
    score.use = condition.condition->use;
    score.samples = static_cast<long>(condition.rows.size());
    score.time_s = condition.record->time_s;
    score.not_scored = why;
    for (const double t : score.time_s) score.drive.push_back(condition.inputs.drive.value(t));
    for (const ProblemChannel& channel : condition.channels)
      score.series[channel.channel] = {condition.record->channels.at(channel.channel).mean, {}};
  }
  return scores;
}

std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores) {
  const metrics::MetricSpec& rho2 = *metrics::find_metric("rho2");
  std::vector<std::string> warnings;
  for (const ConditionScore& score : scores) {
    for (const ChannelScore& channel : score.channels) {
      if (std::isnan(channel.metrics.rho2) || !channel.noise_floor || score.samples < 2) continue;
      // The variance estimated from n samples of noise has a relative standard deviation of sqrt(2
      // / n).
      const double margin = 5.0 * std::sqrt(2.0 / static_cast<double>(score.samples));
      const double unexplained = 1.0 - channel.metrics.rho2;
      const double least = 1.0 - channel.noise_floor->rho2;
      if (unexplained >= least * (1.0 - std::max(0.2, margin))) continue;
      warnings.push_back(
          fmt::format("condition \"{}\": {} has rho2 = {}, better than the {} that a "
                      "perfect model could reach: the fit follows the noise (overfitting), or the "
                      "noise is smaller than its stated standard deviation",
                      score.id, datasets::info(channel.channel).key,
                      metrics::score_text(rho2, channel.metrics.rho2, channel.noise_floor->rho2),
                      metrics::score_text(rho2, channel.noise_floor->rho2, channel.metrics.rho2)));
    }
  }
  return warnings;
}

}  // namespace rigcal::calib
