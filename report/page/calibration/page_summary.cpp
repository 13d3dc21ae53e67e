#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/score/acceptance.hpp"
#include "calib/score/assessment.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/validity.hpp"
#include "report/text/readable.hpp"
#include "report/text/stopped_sentence.hpp"

namespace rigcal::report {
namespace {

using calib::FitStatus;
using calib::Verdict;

/// Whether an aspect of the assessment names a reason of this code.
bool names(const StoredFit& fit, StoredAspect StoredAssessment::*aspect, std::string_view code) {
  if (!fit.assessment) return false;
  const auto& reasons = ((*fit.assessment).*aspect).reasons;
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const StoredReason& reason) { return reason.code == code; });
}

Json failed_headline() { return make_headline("FAILED", "✕", "bad", kNoUsableResult); }

Json stopped_headline() {
  return make_headline("STOPPED", "✕", "bad", stopped_sentence(calib::StoppedIn::starts));
}

Json fail_headline(const StoredFit& fit) {
  const auto failed = std::count_if(fit.conditions.begin(), fit.conditions.end(),
                                    [](const auto& each) { return each.verdict == Verdict::fail; });
  return make_headline(
      "FAIL", "✕", "bad",
      failed == 0 ? std::string("A limit of the campaign could not be evaluated: the model is "
                                "not validated.")
                  : fmt::format("{} of {} conditions {} outside the campaign's limits: the "
                                "model is not validated.",
                                failed, fit.conditions.size(), failed == 1 ? "is" : "are"));
}

Json headline_of(const StoredFit& fit) {
  if (fit.status == FitStatus::failed) return failed_headline();
  const bool stopped = fit.status == FitStatus::stopped;
  if (stopped && !searched_to_the_end(fit)) return stopped_headline();
  if (fit.verdict == Verdict::fail) return fail_headline(fit);
  // After FAIL: a limit that is broken stays broken, whatever else was not finished.
  if (stopped) {
    return make_headline("STOPPED", "!", "warn", stopped_sentence(*fit.stopped_in));
  }
  if (fit.verdict == Verdict::warn) {
    return make_headline("WARN", "!", "warn",
                         fmt::format("Passed with reservations ({}).", open_aspects(fit)));
  }
  if (fit.verdict == Verdict::pass) {
    return make_headline("PASS", "✓", "good",
                         "Within the campaign's limits, validated on records that the fit did not "
                         "use, no lack of fit beyond what is allowed, parameters identified.");
  }
  if (names(fit, &StoredAssessment::agreement, "poor_agreement")) {
    return make_headline("POOR", "✕", "bad",
                         "No limits were given, but the model does not describe the records.");
  }
  if (fit.conditions.empty())
    return make_headline("NOT JUDGED", "○", "none", "No condition was scored.");
  return make_headline(
      "NOT JUDGED", "○", "none",
      "The campaign gives no limits: whether this is good enough is for you to say.");
}

/// What one quantity was, where the model was fitted and where it was validated.
std::string coverage_text(const std::optional<Range>& fitted, const std::optional<Range>& validated,
                          std::string_view unit) {
  if (!validated || (fitted && fitted->low == validated->low && fitted->high == validated->high))
    return in_words(*fitted, unit);
  if (!fitted) return fmt::format("validated {}", in_words(*validated, unit));
  return fmt::format("fitted {}, validated {}", in_words(*fitted, unit),
                     in_words(*validated, unit));
}

Json coverage_rows(const StoredFit& fit) {
  Json rows = Json::array();
  const auto add = [&](std::optional<Range> StoredValidity::*range, const char* name,
                       std::string_view unit) {
    const std::optional<Range>& fitted = fit.validity.*range;
    // A validation covers both at once.
    const std::optional<Range> validated =
        is_fit_schema(fit.schema) && fit.validated ? (*fit.validated).*range : std::nullopt;
    if (!fitted && !validated) return;
    rows.push_back({{"name", name}, {"text", coverage_text(fitted, validated, unit)}});
  };
  add(&StoredValidity::frequency_hz, "Frequency", "Hz");
  if (rows.empty()) {
    rows.push_back({{"name", "Frequency"}, {"text", "not stated: the signals are recorded ones"}});
  }
  add(&StoredValidity::amplitude_m, "Amplitude (half of peak to peak)", "m");
  add(&StoredValidity::amplitude_v, "Amplitude (half of peak to peak)", "V");
  add(&StoredValidity::supply_pressure_pa, "Supply pressure", "Pa");
  add(&StoredValidity::leakage_coefficient, "Leakage coefficient", "1");
  return rows;
}

/// What the ranges are: of a model that is not validated, no more than what was tried.
std::string coverage_title(const StoredFit& fit) {
  const bool valid =
      fit.assessment && calib::has_range_of_validity(fit.assessment->agreement.state,
                                                     fit.assessment->validation.state);
  return valid && is_fit_schema(fit.schema)
             ? "Range of validity: outside it the model is not validated"
             : "Conditions tested";
}

/// What a decision rule means for who reads the verdict (ISO/IEC 17025, 7.8.6).
std::string rule_text(datasets::DecisionRule rule) {
  switch (rule) {
    case datasets::DecisionRule::simple:
      return "Scores are compared with the campaign's limits as they are; their own uncertainty is "
             "not taken off.";
    case datasets::DecisionRule::guard_band:
      return "PASS where a score keeps its limit by more than its expanded uncertainty (95 %, from "
             "the repeats and the stated uncertainty of the sensors); WARN where by less; FAIL "
             "where "
             "it breaks the limit.";
  }
  throw std::logic_error("rule_text: no words for a decision rule");
}

/// Frequency to sort by, and "0.1 Hz sine".
std::pair<double, std::string> signal_of(const StoredCondition& condition) {
  const std::string waveform =
      condition.waveform ? std::string(to_string(*condition.waveform)) : std::string();
  const std::optional<double>& frequency = condition.frequency_hz;
  if (!frequency) return {0.0, waveform};
  return {*frequency, fmt::format("{:.6g} Hz {}", *frequency, waveform)};
}

/// The limits of one channel, to be shown.
Json limits_view(const std::vector<StoredLimit>& limits, const std::string& channel) {
  Json view = Json::array();
  for (const StoredLimit& limit : limits) {
    if (limit.channel != channel) continue;
    view.push_back({{"metric", limit.metric},
                    {"limit", shown_in(limit.limit, 1.0, 6)},
                    {"has_warn", limit.warn.has_value()},
                    {"warn", shown_in(limit.warn, 1.0, 6)}});
  }
  return view;
}

Json matrix_entry(const StoredCondition& condition, const std::string& channel) {
  const StoredScore* scores = find(condition.metrics, channel);
  const bool failed = condition.failure.has_value();
  if (scores == nullptr && !failed) return nullptr;
  Json entry;
  entry["condition"] = condition.id;
  entry["anchor"] = anchor(condition.id);
  entry["use"] = to_string(condition.use);
  entry["badge"] = badge(condition.verdict_of(channel));
  entry["failed"] = failed;
  if (!failed) {
    entry["rho2"] = shown_agreement(scores->rho2);
    entry["error"] = shown_in(scores->absolute_error_percent, 1.0, 3);
  }
  return entry;
}

/// What the table of scores of a channel says of its limits.
void add_limits(const StoredFit& fit, const std::string& channel, Json& table) {
  table["limits"] = limits_view(fit.acceptance, channel);
  table["has_limits"] = !table["limits"].empty();
  table["own"] = Json::array();
  for (const StoredCondition& condition : fit.conditions) {
    if (!condition.acceptance) continue;
    Json own = limits_view(*condition.acceptance, channel);
    table["own"].push_back(
        {{"condition", condition.id}, {"judged", !own.empty()}, {"limits", own}});
  }
}

std::string level_of(const StoredCondition& condition) { return condition.leak_level.value_or(""); }

}  // namespace

bool searched_to_the_end(const StoredFit& fit) {
  return fit.status == FitStatus::converged ||
         (fit.status == FitStatus::stopped && fit.stopped_in &&
          fit.stopped_in != calib::StoppedIn::starts);
}

Json headline_view(const StoredFit& fit) {
  Json view = headline_of(fit);
  if (fit.status != FitStatus::converged) add_reason(view, fit.message, "starts");
  view["aspects"] = assessment_view(fit);
  view["has_aspects"] = !view["aspects"].empty();
  view["has_rule"] = !fit.acceptance.empty();
  const auto rule = fit.decision.value_or(datasets::DecisionRule::simple);
  view["rule"] = std::string(calib::words_of(rule));
  view["rule_text"] = rule_text(rule);
  view["coverage"] = coverage_rows(fit);
  view["coverage_title"] = coverage_title(fit);
  view["levels"] = fmt::format("{}", fmt::join(fit.validity.leak_levels, "; "));
  view["has_levels"] = !fit.validity.leak_levels.empty();
  view["has_coverage"] = fit.status != FitStatus::failed;
  view["status"] = to_string(fit.status);
  view["message"] = fit.message;
  return view;
}

Json tables_headline(const StoredTablesFit& fit) {
  if (fit.status != FitStatus::converged) {
    Json view = fit.status == FitStatus::failed ? failed_headline() : stopped_headline();
    add_reason(view, fit.message, {});
    return view;
  }
  Json view = make_headline(
      "FITTED", "○", "none",
      fmt::format("Estimated from {} published numbers; their weighted logarithms are off by "
                  "{:.1f} % rms.",
                  fit.residual_count, 100.0 * fit.rms.value_or(0.0)));
  for (const StoredParameter& p : fit.parameters) {
    if (!p.reason.empty())
      add_reason(view, fmt::format("{}: {}", parameter_label(p), p.reason), "parameters");
  }
  return view;
}

Json matrix_view(const StoredFit& fit) {
  std::vector<std::string> channels;
  std::vector<std::pair<double, std::string>> signals;
  std::vector<std::string> levels;
  const auto remember = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const StoredCondition& condition : fit.conditions) {
    for (const auto& [channel, metrics] : condition.metrics) remember(channels, channel);
    remember(signals, signal_of(condition));
    remember(levels, level_of(condition));
  }
  std::stable_sort(signals.begin(), signals.end());
  if (channels.empty() && !signals.empty()) channels.emplace_back("position");
  Json view = Json::array();
  for (const std::string& channel : channels) {
    Json table;
    table["channel"] = channel;
    add_limits(fit, channel, table);
    table["levels"] = Json::array();
    for (const std::string& level : levels) {
      table["levels"].push_back(level.empty() ? std::string("no leak level")
                                              : fmt::format("leak {}", level));
    }
    table["rows"] = Json::array();
    for (const auto& signal : signals) {
      Json row{{"signal", signal.second}, {"cells", Json::array()}};
      for (const std::string& level : levels) {
        Json entries = Json::array();
        for (const StoredCondition& condition : fit.conditions) {
          if (signal_of(condition) != signal || level_of(condition) != level) continue;
          Json entry = matrix_entry(condition, channel);
          if (!entry.is_null()) entries.push_back(std::move(entry));
        }
        for (Json& entry : entries) entry["several"] = entries.size() > 1;
        row["cells"].push_back({{"entries", std::move(entries)}});
      }
      table["rows"].push_back(std::move(row));
    }
    view.push_back(std::move(table));
  }
  return view;
}

Json groups_view(const StoredFit& fit) {
  Json rows = Json::array();
  for (const StoredGroup& group : fit.groups) {
    for (const auto& [channel, scores] : group.metrics) {
      std::string by = group.by;
      std::replace(by.begin(), by.end(), '_', ' ');
      rows.push_back({{"by", by},
                      {"label", group.label},
                      {"channel", channel},
                      {"conditions", fmt::format("{}", scores.conditions)},
                      {"rho2", shown_agreement(scores.mean.rho2)},
                      {"ccc", shown_agreement(scores.mean.ccc)},
                      {"error", shown_in(scores.mean.absolute_error_percent, 1.0, 3)},
                      {"worst", shown_agreement(scores.worst.rho2)},
                      {"worst_error", shown_in(scores.worst.absolute_error_percent, 1.0, 3)}});
    }
  }
  return rows;
}

}  // namespace rigcal::report
