#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/metric_table.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

std::string joined(const Json& texts) {
  std::string text;
  for (const Json& each : texts) text += (text.empty() ? "" : "; ") + each.get<std::string>();
  return text;
}

/// Whether an aspect of the assessment names a reason of this code.
bool names(const Json& result, const char* aspect, std::string_view code) {
  const auto assessment = result.find("assessment");
  if (assessment == result.end()) return false;
  const Json& reasons = assessment->at(aspect).at("reasons");
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const Json& reason) { return text_of(reason, "code") == code; });
}

Json headline_of(const Json& result) {
  const std::string status = text_of(result, "status");
  if (status == "failed")
    return make_headline("FAILED", "✕", "bad",
                         "There is no usable result: no number below may be used.");
  const std::string stopped_in = text_of(result, "stopped_in");
  const bool fit_ended = !stopped_in.empty() && stopped_in != "starts";
  if (status == "stopped" && !fit_ended) {
    return make_headline(
        "STOPPED", "✕", "bad",
        "Ended before it converged: these are the best values so far, not a calibration.");
  }
  const std::string verdict = text_of(result, "verdict");
  const Json& conditions = result.at("conditions");
  const std::size_t all = conditions.size();
  if (verdict == "FAIL") {
    const auto failed = std::count_if(conditions.begin(), conditions.end(), [](const Json& each) {
      return text_of(each, "verdict") == "FAIL";
    });
    return make_headline(
        "FAIL", "✕", "bad",
        failed == 0 ? std::string("A limit of the campaign could not be evaluated: the model is "
                                  "not validated.")
                    : fmt::format("{} of {} conditions {} outside the campaign's limits: the "
                                  "model is not validated.",
                                  failed, all, failed == 1 ? "is" : "are"));
  }
  // After FAIL: a limit that is broken stays broken, whatever else was not finished.
  if (status == "stopped") {
    return make_headline(
        "STOPPED", "!", "warn",
        stopped_in == "validation"
            ? "Some conditions were not scored."
            : "The fit converged and was scored; not all that was asked for beside it was "
              "finished.");
  }
  if (verdict == "WARN") {
    return make_headline("WARN", "!", "warn",
                         fmt::format("Passed with reservations ({}).", open_aspects(result)));
  }
  if (verdict == "PASS") {
    return make_headline("PASS", "✓", "good",
                         "Within the campaign's limits, validated on records that the fit did not "
                         "use, no lack of fit beyond what is allowed, parameters identified.");
  }
  if (names(result, "agreement", "poor_agreement")) {
    return make_headline("POOR", "✕", "bad",
                         "No limits were given, but the model does not describe the records.");
  }
  if (all == 0) return make_headline("NOT JUDGED", "○", "none", "No condition was scored.");
  return make_headline(
      "NOT JUDGED", "○", "none",
      "The campaign gives no limits: whether this is good enough is for you to say.");
}

Json range_row(const Json& validity, const char* key, const char* name, std::string_view unit) {
  const auto found = validity.find(key);
  if (found == validity.end() || !found->is_array()) return nullptr;
  const Json low = shown((*found).at(0), unit, 4);
  const Json high = shown((*found).at(1), unit, 4);
  return {{"name", name}, {"low", low}, {"high", high}, {"single", low == high}};
}

Json coverage_rows(const Json& validity) {
  Json rows = Json::array();
  const auto add = [&](const char* key, const char* name, std::string_view unit) {
    Json row = range_row(validity, key, name, unit);
    if (!row.is_null()) rows.push_back(std::move(row));
  };
  add("frequency_hz", "Frequency", "Hz");
  if (rows.empty()) {
    const Json unstated{{"exact", ""}, {"text", "not stated: the signals are recorded ones"}};
    rows.push_back(
        {{"name", "Frequency"}, {"low", unstated}, {"high", unstated}, {"single", true}});
  }
  add("amplitude_m", "Amplitude (half of peak to peak)", "m");
  add("amplitude_v", "Amplitude (half of peak to peak)", "V");
  add("supply_pressure_pa", "Supply pressure", "Pa");
  add("leakage_coefficient", "Leakage coefficient", "1");
  return rows;
}

/// "sine 0.1 Hz", and the frequency to sort by.
std::pair<double, std::string> signal_of(const Json& condition) {
  const auto frequency = number_of(condition, "frequency_hz");
  const std::string waveform = text_of(condition, "waveform");
  if (!frequency) return {0.0, waveform};
  return {*frequency, fmt::format("{:.6g} Hz {}", *frequency, waveform)};
}

/// The limits of one channel, to be shown.
Json limits_view(const Json& limits, const std::string& channel) {
  Json view = Json::array();
  for (const Json& limit : limits) {
    if (text_of(limit, "channel") != channel) continue;
    view.push_back({{"metric", text_of(limit, "metric")},
                    {"limit", shown_in(limit.at("limit"), 1.0, 6)},
                    {"has_warn", limit.at("warn").is_number()},
                    {"warn", shown_in(limit.at("warn"), 1.0, 6)}});
  }
  return view;
}

Json matrix_entry(const Json& condition, const std::string& channel) {
  const Json& metrics = condition.at("metrics");
  const auto scores = metrics.find(channel);
  const bool failed = !text_of(condition, "failure").empty();
  if (scores == metrics.end() && !failed) return nullptr;
  Json entry;
  entry["condition"] = text_of(condition, "id");
  entry["anchor"] = anchor(text_of(condition, "id"));
  entry["use"] = text_of(condition, "use");
  entry["badge"] = badge(channel_verdict(condition, channel));
  entry["failed"] = failed;
  if (!failed) {
    entry["rho2"] = shown_agreement(scores->at("rho2"));
    entry["error"] = shown_in(scores->at("absolute_error_percent"), 1.0, 3);
  }
  return entry;
}

}  // namespace

Json headline_view(const Json& result) {
  Json view = headline_of(result);
  if (text_of(result, "status") != "converged")
    add_reason(view, text_of(result, "message"), "starts");
  view["aspects"] = assessment_view(result);
  view["has_aspects"] = !view["aspects"].empty();
  view["has_rule"] = !result.at("acceptance").empty();
  view["coverage"] = coverage_rows(result.at("validity"));
  view["levels"] = joined(result.at("validity").at("leak_levels"));
  view["has_levels"] = !result.at("validity").at("leak_levels").empty();
  view["has_coverage"] = text_of(result, "status") != "failed";
  view["status"] = text_of(result, "status");
  view["message"] = text_of(result, "message");
  return view;
}

Json tables_headline(const Json& result) {
  const std::string status = text_of(result, "status");
  if (status != "converged") {
    Json view = headline_of(result);
    add_reason(view, text_of(result, "message"), {});
    return view;
  }
  Json view = make_headline(
      "FITTED", "○", "none",
      fmt::format("Estimated from {} published numbers; their weighted logarithms are off by "
                  "{:.1f} % rms.",
                  result.at("residual_count").get<int>(),
                  100.0 * number_of(result, "rms").value_or(0.0)));
  for (const Json& p : result.at("parameters")) {
    if (!text_of(p, "reason").empty())
      add_reason(view, fmt::format("{}: {}", parameter_label(p), text_of(p, "reason")),
                 "parameters");
  }
  return view;
}

Json matrix_view(const Json& result) {
  std::vector<std::string> channels;
  std::vector<std::pair<double, std::string>> signals;
  std::vector<std::string> levels;
  const auto remember = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const Json& condition : result.at("conditions")) {
    for (const auto& [channel, metrics] : condition.at("metrics").items())
      remember(channels, channel);
    remember(signals, signal_of(condition));
    remember(levels, text_of(condition, "leak_level"));
  }
  std::stable_sort(signals.begin(), signals.end());
  if (channels.empty() && !signals.empty()) channels.emplace_back("position");
  Json view = Json::array();
  for (const std::string& channel : channels) {
    Json table;
    table["channel"] = channel;
    table["limits"] = limits_view(result.at("acceptance"), channel);
    table["has_limits"] = !table["limits"].empty();
    table["own"] = Json::array();
    for (const Json& condition : result.at("conditions")) {
      if (!condition.contains("acceptance")) continue;
      Json own = limits_view(condition.at("acceptance"), channel);
      table["own"].push_back(
          {{"condition", text_of(condition, "id")}, {"judged", !own.empty()}, {"limits", own}});
    }
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
        for (const Json& condition : result.at("conditions")) {
          if (signal_of(condition) != signal || text_of(condition, "leak_level") != level) continue;
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

Json groups_view(const Json& result) {
  Json rows = Json::array();
  for (const Json& group : result.at("groups")) {
    for (const auto& [channel, scores] : group.at("metrics").items()) {
      std::string by = text_of(group, "by");
      std::replace(by.begin(), by.end(), '_', ' ');
      rows.push_back(
          {{"by", by},
           {"label", text_of(group, "label")},
           {"channel", channel},
           {"conditions", fmt::format("{}", scores.at("conditions").get<int>())},
           {"rho2", shown_agreement(scores.at("mean").at("rho2"))},
           {"ccc", shown_agreement(scores.at("mean").at("ccc"))},
           {"error", shown_in(scores.at("mean").at("absolute_error_percent"), 1.0, 3)},
           {"worst", shown_agreement(scores.at("worst").at("rho2"))},
           {"worst_error", shown_in(scores.at("worst").at("absolute_error_percent"), 1.0, 3)}});
    }
  }
  return rows;
}

}  // namespace rigcal::report
