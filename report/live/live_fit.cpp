#include "report/live/live_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/problem/known_values.hpp"
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

/// Maximum number of conditions; a longer list would be hard to choose from. The worst come first.
constexpr std::size_t kMostCases = 40;
/// Maximum number of samples in total; 2 MB as 32-bit numbers.
constexpr std::size_t kMostSamples = 500'000;
/// Minimum number of samples for each condition, even if that exceeds the total.
constexpr std::size_t kLeastOfACase = 500;

bool is_estimate(const calib::FittedParameter& p) { return p.fitted && std::isfinite(p.value); }

/// Returns true if an estimate applies to a condition.
///
/// @param p  an estimate for the rig, a leak level or a condition
template <typename Estimate>
bool acts_in(const Estimate& p, const Condition& condition) {
  return p.scope == datasets::Scope::rig ||
         (p.scope == datasets::Scope::leak_level && p.level == condition.leak_level) ||
         (p.scope == datasets::Scope::condition && p.level == condition.id);
}

/// Returns the values at which a condition was scored, including nuisance parameters. In a
/// validation, the parameters that the campaign fits have the values of an earlier fit.
model::ParameterValues scored_values(const datasets::Campaign& campaign, const Condition& condition,
                                     const calib::Fit& fit) {
  std::vector<datasets::FittedValue> known;
  for (const calib::FittedParameter& p : fit.parameters) {
    const datasets::ParameterSetting* setting = campaign.setting(p.index);
    const bool by_a_fit = p.fitted || (setting != nullptr && setting->fit);
    if (by_a_fit && !p.nuisance && std::isfinite(p.value))
      known.push_back({p.index, p.scope, p.level.value_or(""), p.value});
  }
  model::ParameterValues values = calib::values_with(campaign, condition, known);
  for (const calib::FittedParameter& p : fit.parameters)
    if (is_estimate(p) && p.nuisance && acts_in(p, condition)) values.set(p.index, p.value);
  return values;
}

std::vector<const calib::ConditionScore*> shown_first(const calib::Fit& fit) {
  std::vector<const calib::ConditionScore*> scores;
  for (const calib::ConditionScore& score : fit.conditions)
    if (!score.failure && !score.not_scored && score.time_s.size() > 1) scores.push_back(&score);
  std::stable_sort(scores.begin(), scores.end(), [](const auto* a, const auto* b) {
    return calib::shown_before(a->use, calib::badness(*a), b->use, calib::badness(*b));
  });
  if (scores.size() > kMostCases) scores.resize(kMostCases);
  return scores;
}

/// Returns the first and last sample of each window in the mask.
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

/// Returns the first and last sample of each window in a record.
Json windows_of(const datasets::Record& record) {
  std::vector<bool> counts;
  for (const double t : record.windows.empty() ? std::vector<double>() : record.time_s)
    counts.push_back(std::any_of(record.windows.begin(), record.windows.end(),
                                 [&](const datasets::TimeWindow& window) {
                                   return t >= window.start_s && t <= window.end_s;
                                 }));
  return windows_of(counts, record.time_s.size());
}

/// Encodes sample times as start, step and number, or one by one if they are not equidistant.
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
  for (const calib::LimitCheck& check : score.limit_checks) {
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

struct MeasuredCase {
  struct Measured {
    datasets::Channel channel;
    model::Output output;
    const std::vector<double>* mean = nullptr;  ///< borrowed, shape (samples)
    Json limits = Json::array();
  };
  const std::vector<double>* time_s = nullptr;  ///< borrowed
  Json windows;                                 ///< first and last sample of each scored window
  bool held_back = false;
  std::vector<Measured> channels;  ///< channels for which the model has an output
};

MeasuredCase measured_case(const calib::ConditionScore& score) {
  MeasuredCase found{&score.time_s,
                     windows_of(score.in_window, score.time_s.size()),
                     score.use == datasets::Use::validate,
                     {}};
  for (const calib::ChannelScore& channel : score.channels) {
    const auto output = datasets::model_output(channel.channel);
    const auto series = score.series.find(channel.channel);
    if (output && series != score.series.end())
      found.channels.push_back(
          {channel.channel, *output, &series->second.first, limits_of(score, channel.channel)});
  }
  return found;
}

/// @param every  only every `every`-th sample is included
Json samples_json(const MeasuredCase::Measured& measured, std::size_t every) {
  std::vector<double> taken;
  taken.reserve(measured.mean->size() / every + 1);
  for (std::size_t i = 0; i < measured.mean->size(); i += every)
    taken.push_back((*measured.mean)[i]);
  return {{"channel", info(measured.channel).key},
          {"unit", info(measured.channel).unit},
          {"output", model::output_name(measured.output)},
          {"values", floats_base64(taken)},
          {"limits", measured.limits}};
}

/// Adds the measured means to the cases, thinned so that all of them stay within the common limit.
void add_measured(const std::vector<MeasuredCase>& measured, Json& cases) {
  std::size_t left = kMostSamples;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const MeasuredCase& each = measured[i];
    const std::size_t others = kLeastOfACase * (measured.size() - i - 1);
    const std::size_t wanted = each.time_s->size() * each.channels.size();
    const std::size_t room = std::max(left > others ? left - others : 0, kLeastOfACase);
    const std::size_t every = wanted <= room ? 1 : (wanted + room - 1) / room;
    left -= std::min(left, wanted / every);
    Json& row = cases[i];
    row["every"] = every;
    row["times"] = times_of(*each.time_s);
    row["windows"] = each.windows;
    row["held_back"] = each.held_back;
    row["measured"] = Json::array();
    for (const MeasuredCase::Measured& channel : each.channels)
      row["measured"].push_back(samples_json(channel, every));
  }
}

/// Returns the rig and its cases for embedding in the page of a result.
Json embedded_rig(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases,
                  const std::vector<MeasuredCase>& measured) {
  Json rig = live_rig(campaign, cases);
  rig["embedded"] = true;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Json& row = rig["cases"][i];
    row["level"] = cases[i].condition.leak_level.value_or("");
    row["campaign"] = given_values(values_in(campaign, cases[i].condition));
  }
  add_measured(measured, rig["cases"]);
  return rig;
}

/// Returns the intervals of the estimates. An interval for a leak level applies to the conditions
/// with that level.
Json intervals_of(const calib::Fit& fit) {
  Json intervals = Json::array();
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!is_estimate(p) || p.nuisance || !p.ci95 || !std::isfinite(p.ci95->low) ||
        !std::isfinite(p.ci95->high))
      continue;
    intervals.push_back({{"index", p.index},
                         {"level", p.level.value_or("")},
                         {"scope", to_string(p.scope)},
                         {"low", p.ci95->low},
                         {"high", p.ci95->high}});
  }
  return intervals;
}

}  // namespace

std::optional<Json> live_fit(const Result& result) {
  const calib::Fit& fit = result.fit;
  if (!fit.has_converged()) return std::nullopt;
  std::vector<MeasuredCase> measured;
  std::vector<LiveCase> cases;
  for (const calib::ConditionScore* score : shown_first(fit)) {
    const Condition* condition = result.campaign.find(score->id);
    const auto record =
        std::find_if(result.records.begin(), result.records.end(),
                     [&](const datasets::Record& each) { return each.condition == score->id; });
    if (condition == nullptr || record == result.records.end()) continue;
    MeasuredCase found = measured_case(*score);
    if (found.channels.empty()) continue;
    cases.push_back(live_case(result.campaign, score->id, *condition,
                              scored_values(result.campaign, *condition, fit), *record));
    if (cases.back().task.time_s != score->time_s) {
      cases.pop_back();
      continue;
    }
    measured.push_back(std::move(found));
  }
  if (cases.empty()) return std::nullopt;
  Json rig = embedded_rig(result.campaign, cases, measured);
  rig["tolerance"] = fit.tolerance;
  rig["intervals"] = intervals_of(fit);
  return rig;
}

std::optional<Json> live_diagnosis(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& averages,
                                   const std::vector<datasets::FittedValue>& healthy,
                                   const diagnosis::Diagnosis& found) {
  const int leak = model::parameter_index(campaign.rig.plant,
                                          datasets::leak_parameter(campaign.diagnosis.leak_law));
  std::vector<const diagnosis::RecordDiagnosis*> shown;
  for (const diagnosis::RecordDiagnosis& record : found.records)
    if (!record.repeat && record.fit.ok() && !record.estimate.incompatible)
      shown.push_back(&record);
  std::stable_sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) {
    return a->estimate.coefficient > b->estimate.coefficient;
  });
  if (shown.size() > kMostCases) shown.resize(kMostCases);
  std::vector<MeasuredCase> measured;
  std::vector<LiveCase> cases;
  Json intervals = Json::array();
  for (const diagnosis::RecordDiagnosis* record : shown) {
    const Condition* condition = campaign.find(record->condition);
    const auto average = std::find_if(
        averages.begin(), averages.end(),
        [&](const datasets::Record& each) { return each.condition == record->condition; });
    if (condition == nullptr || average == averages.end()) continue;
    MeasuredCase means{&average->time_s, windows_of(*average), false, {}};
    for (const auto& [channel, series] : average->channels)
      if (const auto output = datasets::model_output(channel))
        means.channels.push_back({channel, *output, &series.mean});
    model::ParameterValues values = values_in(campaign, *condition);
    for (const datasets::FittedValue& p : healthy)
      if (p.index != leak && acts_in(p, *condition)) values.set(p.index, p.value);
    values.set(leak, std::max(0.0, record->estimate.coefficient));
    if (means.channels.empty() || !values.missing().empty()) continue;
    cases.push_back(live_case(campaign, condition->id, *condition, std::move(values), *average));
    if (cases.back().task.time_s != average->time_s) {
      cases.pop_back();
      continue;
    }
    measured.push_back(std::move(means));
    const auto& [low, high] = record->estimate.ci95;
    if (std::isfinite(low) && std::isfinite(high))
      intervals.push_back({{"index", leak},
                           {"level", condition->id},
                           {"scope", to_string(datasets::Scope::condition)},
                           {"low", low},
                           {"high", high}});
  }
  if (cases.empty()) return std::nullopt;
  Json rig = embedded_rig(campaign, cases, measured);
  rig["intervals"] = std::move(intervals);
  return rig;
}

std::optional<LiveSection> live_section(const Json& rig) {
  if (live_module().empty()) return std::nullopt;
  LiveSection section;
  const bool estimated = rig.contains("intervals");
  const bool shaded = estimated && !rig["intervals"].empty();
  const std::string about = fmt::format(
      "The {}rig, simulated in this page by the equations and solver of <code>rigcal</code>. "
      "Sliders start at the {}, shown by a mark{}.{}",
      estimated ? "calibrated " : "", estimated ? "estimates" : "values of the result",
      shaded ? "; the shaded range is the 95 % interval" : "",
      estimated ? " Scores and limits refer to the curves shown." : "");
  section.html = fmt::format(
      "<style>{}</style>\n<section id=\"try\" class=\"screen\" aria-labelledby=\"try-title\">\n"
      "<h2 id=\"try-title\">Try it</h2>\n<p class=\"reading\">{}</p>\n{}</section>\n\n",
      asset("live.css"), about, live_html("", ""));
  section.scripts = live_scripts(rig);
  return section;
}

}  // namespace rigcal::report
