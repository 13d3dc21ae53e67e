#include "report/live/live_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "datasets/synthetic/model_output.hpp"
#include "metrics/metric_table.hpp"
#include "report/document/assets.hpp"
#include "report/figure/decimate.hpp"
#include "report/json/read_json.hpp"
#include "report/live/live_module.hpp"
#include "report/live/live_page.hpp"
#include "report/live/live_rig.hpp"

namespace rigcal::report {
namespace {

using datasets::Condition;

/// More would make the list too long to choose from; the worst come first.
constexpr std::size_t kMostCases = 40;
/// As 32-bit numbers these are 2 MB.
constexpr std::size_t kMostSamples = 500'000;
/// A condition beyond that limit keeps at least so many.
constexpr std::size_t kLeastOfACase = 500;

bool is_estimate(const calib::FittedParameter& p) { return p.fitted && std::isfinite(p.value); }

/// Values of a condition at the optimum, nuisance parameters included.
model::ParameterValues values_at_optimum(const datasets::Campaign& campaign,
                                         const Condition& condition, const calib::Fit& fit) {
  model::ParameterValues values = values_in(campaign, condition);
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!is_estimate(p)) continue;
    const bool here = p.scope == datasets::Scope::rig ||
                      (p.scope == datasets::Scope::leak_level && p.level == condition.leak_level) ||
                      (p.scope == datasets::Scope::condition && p.level == condition.id);
    if (here) values.set(p.index, p.value);
  }
  return values;
}

/// The part of the tolerance that a condition uses, or its error where it has no limits.
double used(const calib::ConditionScore& score) {
  double most = 0.0;
  for (const calib::LimitCheck& check : score.checks) most = std::max(most, check.used);
  if (score.checks.empty())
    for (const calib::ChannelScore& channel : score.channels)
      if (channel.agreement) most = std::max(most, channel.agreement->absolute_error_percent);
  return most;
}

std::vector<const calib::ConditionScore*> shown_first(const calib::Fit& fit) {
  std::vector<const calib::ConditionScore*> scores;
  for (const calib::ConditionScore& score : fit.conditions)
    if (score.failure.empty() && score.not_scored.empty() && score.time_s.size() > 1)
      scores.push_back(&score);
  std::stable_sort(scores.begin(), scores.end(), [](const auto* a, const auto* b) {
    const bool held_back = a->use == datasets::Use::validate;
    if (held_back != (b->use == datasets::Use::validate)) return held_back;
    return used(*a) > used(*b);
  });
  if (scores.size() > kMostCases) scores.resize(kMostCases);
  return scores;
}

/// First and last sample of each window that counts.
Json windows_of(const std::vector<bool>& in_window, std::size_t samples) {
  if (in_window.empty()) return {{0, samples - 1}};
  Json windows = Json::array();
  for (std::size_t i = 0; i < in_window.size(); ++i) {
    if (!in_window[i]) continue;
    if (i == 0 || !in_window[i - 1]) windows.push_back({i, i});
    windows.back()[1] = i;
  }
  return windows;
}

/// Sample times as start, step and number, or each where they are not regular.
Json times_of(const std::vector<double>& time_s) {
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const bool regular = [&] {
    for (std::size_t i = 0; i < time_s.size(); ++i)
      if (std::abs(time_s.front() + static_cast<double>(i) * step_s - time_s[i]) > 1e-9 * step_s)
        return false;
    return true;
  }();
  if (!regular) return doubles_base64(time_s);
  return {{"start", time_s.front()}, {"step", step_s}, {"count", time_s.size()}};
}

Json limits_of(const calib::ConditionScore& score, datasets::Channel channel) {
  Json limits = Json::array();
  for (const calib::LimitCheck& check : score.checks) {
    if (check.channel != channel || !check.limit) continue;
    const auto metric =
        std::find_if(metrics::kMetrics.begin(), metrics::kMetrics.end(),
                     [&](const metrics::MetricSpec& spec) { return spec.name == check.metric; });
    if (metric == metrics::kMetrics.end()) continue;
    limits.push_back({{"metric", check.metric},
                      {"limit", *check.limit},
                      {"higher_is_better", metric->higher_is_better}});
  }
  return limits;
}

/// @param every  of so many samples one is taken
Json measured_channel(const calib::ConditionScore& score, const calib::ChannelScore& channel,
                      model::Output output, std::size_t every) {
  const std::vector<double>& measured = score.series.at(channel.channel).first;
  std::vector<double> taken;
  taken.reserve(measured.size() / every + 1);
  for (std::size_t i = 0; i < measured.size(); i += every) taken.push_back(measured[i]);
  return {{"channel", info(channel.channel).key},
          {"unit", info(channel.channel).unit},
          {"output", model::output_name(output)},
          {"values", floats_base64(taken)},
          {"limits", limits_of(score, channel.channel)}};
}

/// Channels that the model has an output for.
std::vector<std::pair<const calib::ChannelScore*, model::Output>> compared(
    const calib::ConditionScore& score) {
  std::vector<std::pair<const calib::ChannelScore*, model::Output>> channels;
  for (const calib::ChannelScore& channel : score.channels) {
    const auto output = datasets::model_output(channel.channel);
    if (output && score.series.contains(channel.channel)) channels.emplace_back(&channel, *output);
  }
  return channels;
}

/// Measured means of the cases, within the limit of all.
void add_measured(const std::vector<const calib::ConditionScore*>& scores, Json& cases) {
  std::size_t left = kMostSamples;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const calib::ConditionScore& score = *scores[i];
    const auto channels = compared(score);
    const std::size_t others = kLeastOfACase * (scores.size() - i - 1);
    const std::size_t wanted = score.time_s.size() * channels.size();
    const std::size_t room = std::max(left > others ? left - others : 0, kLeastOfACase);
    const std::size_t every = wanted <= room ? 1 : (wanted + room - 1) / room;
    left -= std::min(left, wanted / every);
    Json& row = cases[i];
    row["every"] = every;
    row["times"] = times_of(score.time_s);
    row["windows"] = windows_of(score.in_window, score.time_s.size());
    row["held_back"] = score.use == datasets::Use::validate;
    row["measured"] = Json::array();
    for (const auto& [channel, output] : channels)
      row["measured"].push_back(measured_channel(score, *channel, output, every));
  }
}

/// Intervals of the estimates; those of a leak level belong to its conditions.
Json intervals_of(const calib::Fit& fit) {
  Json intervals = Json::array();
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!is_estimate(p) || p.nuisance || !p.ci95 || !std::isfinite(p.ci95->first) ||
        !std::isfinite(p.ci95->second))
      continue;
    intervals.push_back({{"index", p.index},
                         {"level", p.level},
                         {"scope", to_string(p.scope)},
                         {"low", p.ci95->first},
                         {"high", p.ci95->second}});
  }
  return intervals;
}

}  // namespace

std::optional<Json> live_fit(const Result& result) {
  const calib::Fit& fit = result.fit;
  if (!fit.has_converged()) return std::nullopt;
  std::vector<const calib::ConditionScore*> scores;
  std::vector<LiveCase> cases;
  for (const calib::ConditionScore* score : shown_first(fit)) {
    const Condition* condition = result.campaign.find(score->id);
    const auto record =
        std::find_if(result.records.begin(), result.records.end(),
                     [&](const datasets::Record& each) { return each.condition == score->id; });
    if (condition == nullptr || record == result.records.end() || compared(*score).empty())
      continue;
    cases.push_back(live_case(result.campaign, score->id, *condition,
                              values_at_optimum(result.campaign, *condition, fit), *record));
    if (cases.back().task.time_s != score->time_s) {
      cases.pop_back();
      continue;
    }
    scores.push_back(score);
  }
  if (cases.empty()) return std::nullopt;
  Json rig = live_rig(result.campaign, cases);
  rig["tolerance"] = fit.tolerance;
  rig["embedded"] = true;
  rig["intervals"] = intervals_of(fit);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Json& row = rig["cases"][i];
    row["level"] = cases[i].condition.leak_level.value_or("");
    row["campaign"] = given_values(values_in(result.campaign, cases[i].condition));
  }
  add_measured(scores, rig["cases"]);
  return rig;
}

std::optional<LiveSection> live_section(const std::string& text, const std::string& where) {
  if (live_module().empty()) return std::nullopt;
  const Json rig = parse_json(text, where);
  LiveSection section;
  section.html =
      "<style>" + std::string(asset("live.css")) +
      "</style>\n<section id=\"try\" class=\"screen\" aria-labelledby=\"try-title\">\n<h2 "
      "id=\"try-title\">Try it</h2>\n<p class=\"reading\">The calibrated rig, solved in this page "
      "as <code>rigcal</code> solves it. It begins at the estimates; a mark on each slider shows "
      "them, and a shade their 95 % interval. Scores and limits are those of the curves "
      "shown.</p>\n" +
      live_html("", "") + "</section>\n\n";
  section.scripts = live_scripts(rig);
  return section;
}

}  // namespace rigcal::report
