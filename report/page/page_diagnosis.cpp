#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "report/page/page_parts.hpp"
#include "report/text/gathered_warnings.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using datasets::LeakClass;

/// Verdict class of the page for a class of leaks.
struct LeakMark {
  const char* mark;
  const char* css;
};

LeakMark mark_of(LeakClass leak_class) {
  switch (leak_class) {
    case LeakClass::normal:
      return {"✓", "good"};
    case LeakClass::slight:
    case LeakClass::medium:
      return {"!", "warn"};
    case LeakClass::critical:
    case LeakClass::supercritical:
      break;
  }
  return {"✕", "bad"};
}

std::string class_text(const std::optional<LeakClass>& leak_class) {
  return leak_class ? std::string(to_string(*leak_class)) : std::string();
}

Json class_badge(LeakClass leak_class) {
  const LeakMark mark = mark_of(leak_class);
  return {{"word", to_string(leak_class)}, {"mark", mark.mark}, {"class", mark.css}};
}

/// A leak below zero: supply or valve are not as in the fit.
Json incompatible_badge() {
  return {{"word", "incompatible with the model"}, {"mark", "✕"}, {"class", "bad"}};
}

Json leak_badge(const StoredDiagnosedRecord& record) {
  if (record.failure) return {{"word", "not fitted"}, {"mark", "✕"}, {"class", "bad"}};
  if (record.is_reference) return {{"word", "reference"}, {"mark", "○"}, {"class", "none"}};
  if (record.leak.compatible_with_model == false) return incompatible_badge();
  if (record.explained_by_leak == false)
    return {{"word", "not explained by a leak"}, {"mark", "✕"}, {"class", "bad"}};
  if (!record.leak.class_) return {{"word", "undecided"}, {"mark", "?"}, {"class", "none"}};
  return class_badge(*record.leak.class_);
}

Json probabilities_view(const StoredDiagnosedRecord& record) {
  Json cells = Json::array();
  for (const auto& [name, value] : record.leak.class_probabilities) {
    const double p = value.value_or(0.0);
    Json cell{{"p", shown_in(value, 1.0, 3)}, {"strength", fmt::format("{:.2f}", p)}};
    if (value) cell["p"]["text"] = fmt::format("{:.3f}", p);
    cells.push_back(std::move(cell));
  }
  return cells;
}

Json diagnosed_row(const StoredDiagnosedRecord& record, std::size_t number) {
  Json row;
  row["number"] = fmt::format("{}", number);
  row["condition"] = record.condition;
  row["repeat"] = record.repeat ? fmt::format("{}", *record.repeat) : std::string();
  row["badge"] = leak_badge(record);
  row["reference"] = record.is_reference;
  row["coefficient"] = shown_in(record.leak.leakage_coefficient, 1.0, 4);
  row["ci"] = shown_interval(record.leak.ci95, 1.0);
  row["share"] = shown_in(record.leak.leak_share_percent, 1.0, 4);
  row["share_ci"] = shown_interval(record.leak.leak_share_ci95_percent, 1.0);
  row["flow"] = shown_in(record.leak.leak_flow_l_per_min, 1.0, 3);
  row["probabilities"] = probabilities_view(record);
  row["by_features"] = class_text(record.class_by_features);
  row["truth"] = class_text(record.true_class);
  row["true_share"] = shown_in(record.true_share_percent, 1.0, 4);
  row["failure"] = record.failure.value_or("");
  row["failed"] = record.failure.has_value();
  return row;
}

/// Shares with their intervals in the order of the table, and the limits of the classes.
Plot share_plot(const StoredDiagnosis& diagnosis) {
  Plot plot;
  plot.title = "Share of the servo flow that leaks, with 95 % intervals, by record";
  plot.x_label = "record of the table";
  plot.y_label = "share of the servo flow [%]";
  plot.height = 240.0;
  plot.whole_x = true;
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model", "found");
  Trace known = empty_trace(Trace::Kind::points, "residual", "known");
  double number = 0.0;
  for (const StoredDiagnosedRecord& record : diagnosis.records) {
    if (!record.is_average()) continue;
    number += 1.0;
    if (record.true_share_percent) {
      known.x.push_back(number);
      known.y.push_back(*record.true_share_percent);
    }
    if (!record.leak.leak_share_percent) continue;
    middles.x.push_back(number);
    middles.y.push_back(*record.leak.leak_share_percent);
    add_interval(spans, number, record.leak.leak_share_ci95_percent);
  }
  double most = 0.0;
  for (const double upper : spans.upper) most = std::max(most, upper);
  for (const double share : middles.y) most = std::max(most, share);
  for (const auto& [name, limit] : diagnosis.settings.limits_percent)
    if (limit > 0.0 && limit <= 1.2 * most) plot.levels.push_back(limit);
  plot.traces.push_back(std::move(spans));
  if (!known.x.empty()) plot.traces.push_back(std::move(known));
  plot.traces.push_back(std::move(middles));
  return plot;
}

Json confusion_view(const StoredConfusion& confusion) {
  Json view{{"found", confusion.found}, {"rows", Json::array()}};
  for (std::size_t i = 0; i < confusion.counts.size(); ++i) {
    const auto& counts = confusion.counts[i];
    const long total = std::accumulate(counts.begin(), counts.end(), 0L);
    if (total == 0) continue;
    Json cells = Json::array();
    for (std::size_t j = 0; j < counts.size(); ++j) {
      cells.push_back({{"count", fmt::format("{}", counts[j])},
                       {"sign", i == j ? "minus" : "plus"},
                       {"strength", fmt::format("{:.2f}", static_cast<double>(counts[j]) /
                                                              static_cast<double>(total))}});
    }
    view["rows"].push_back({{"truth", confusion.truth[i]}, {"cells", std::move(cells)}});
  }
  return view;
}

struct MethodName {
  StoredAccuracy StoredMethods::*accuracy;
  const char* name;
};
constexpr std::array kMethods{
    MethodName{&StoredMethods::fitted_leak_single, "Fitted leak, single repeats"},
    MethodName{&StoredMethods::fitted_leak_averaged, "Fitted leak, averages"},
    MethodName{&StoredMethods::features_leave_one_repeat_out,
               "Paper's features, learned without the repeat"},
    MethodName{&StoredMethods::features_leave_one_signal_out,
               "Paper's features, learned without the signal"}};

Json methods_view(const StoredMethods& methods) {
  Json list = Json::array();
  for (const MethodName& each : kMethods) {
    const StoredAccuracy& method = methods.*each.accuracy;
    if (method.records == 0) continue;
    const auto percent = [](const std::optional<double>& value) {
      return shown_in(value ? std::optional(100.0 * *value) : std::nullopt, 1.0, 4);
    };
    const auto& ci = method.accuracy_ci95;
    list.push_back({{"name", each.name},
                    {"right", fmt::format("{}", method.right)},
                    {"records", fmt::format("{}", method.records)},
                    {"conditions", fmt::format("{}", method.conditions)},
                    {"undecided", fmt::format("{}", method.undecided)},
                    {"off_by_two", fmt::format("{}", method.off_by_two_or_more)},
                    {"accuracy", percent(method.accuracy)},
                    {"low", percent(ci ? std::optional(ci->low) : std::nullopt)},
                    {"high", percent(ci ? std::optional(ci->high) : std::nullopt)},
                    {"confusion", confusion_view(method.confusion)}});
  }
  return list;
}

/// Those of all; then of the records, each once.
std::vector<std::string> diagnosis_warnings(const StoredDiagnosis& diagnosis) {
  std::vector<std::pair<std::string, std::string>> told;
  for (const StoredDiagnosedRecord& record : diagnosis.records) {
    const std::string name = record.is_average()
                                 ? record.condition
                                 : fmt::format("{} repeat {}", record.condition, *record.repeat);
    for (const std::string& warning : record.warnings) told.emplace_back(name, warning);
  }
  std::vector<std::string> list = diagnosis.warnings;
  for (std::string& line : gathered_by_text(told)) list.push_back(std::move(line));
  return list;
}

/// Rows of the leak table that gave the limits; none where [diagnosis] did.
Json class_limits_view(const StoredDiagnosis& diagnosis) {
  Json list = Json::array();
  for (const StoredClassLimit& limit : diagnosis.class_limits) {
    Json roots = Json::array();
    for (std::size_t i = 0; i < limit.coefficients.size(); ++i) {
      roots.push_back({{"value", shown_in(limit.coefficients[i], 1.0, 4)},
                       {"ci", shown_interval(limit.coefficients_ci95[i], 1.0)}});
    }
    list.push_back({{"signal", limit.signal},
                    {"share", shown_in(limit.share_percent, 1.0, 4)},
                    {"class", class_text(limit.class_)},
                    {"roots", std::move(roots)}});
  }
  return list;
}

/// Verdicts on the states of the machine, but for healthy references; the largest leak first.
std::vector<StoredState> judged_states(const StoredDiagnosis& diagnosis) {
  std::vector<StoredState> states;
  for (const StoredState& state : diagnosis.states)
    if (!state.is_reference) states.push_back(state);
  std::stable_sort(states.begin(), states.end(), [](const StoredState& a, const StoredState& b) {
    return a.leak.leak_share_percent.value_or(-1.0) > b.leak.leak_share_percent.value_or(-1.0);
  });
  return states;
}

Json state_badge(const StoredState& state) {
  if (state.is_reference) return {{"word", "reference"}, {"mark", "○"}, {"class", "none"}};
  if (state.leak.compatible_with_model == false) return incompatible_badge();
  if (state.leak.class_) return class_badge(*state.leak.class_);
  return {{"word", state.leak.leakage_coefficient ? "undecided" : "no verdict"},
          {"mark", "?"},
          {"class", "none"}};
}

std::string distance_text(const std::optional<StoredNearestLimit>& limit) {
  if (!limit) return "";
  const double points = limit->distance_percentage_points;
  const std::string_view name = to_string(limit->class_);
  if (limit->on_limit) return fmt::format("on that of {} ({:g} %)", name, limit->percent);
  return fmt::format("{:.1f} points {} {} ({:g} %)", std::abs(points),
                     points < 0.0 ? "below" : "above", name, limit->percent);
}

std::string agreement_text_of(const std::optional<StoredSignalsAgreement>& agreement) {
  if (!agreement) return "one signal";
  return fmt::format("{} ({})", agreement->agree ? "agree" : "disagree",
                     p_value_text(agreement->p));
}

Json state_row(const StoredState& state) {
  Json row;
  row["state"] = state.state;
  row["badge"] = state_badge(state);
  row["share"] = shown_in(state.leak.leak_share_percent, 1.0, 4);
  row["share_ci"] = shown_interval(state.leak.leak_share_ci95_percent, 1.0);
  row["duty"] = state.duty.value_or("");
  row["coefficient"] = shown_in(state.leak.leakage_coefficient, 1.0, 4);
  row["ci"] = shown_interval(state.leak.ci95, 1.0);
  row["area"] = shown_in(state.leak_area_m2, 1e-6, 4);
  row["area_ci"] = shown_interval(state.leak_area_ci95_m2, 1e-6);
  row["limit"] = distance_text(state.nearest_limit);
  row["agreement"] = state.is_reference ? std::string() : agreement_text_of(state.agreement);
  row["left_out"] = state.left_out;
  row["has_left_out"] = !state.left_out.empty() && !state.is_reference;
  return row;
}

Json headline_of_states(const StoredDiagnosis& diagnosis, const std::string& sentence) {
  const std::vector<StoredState> states = judged_states(diagnosis);
  const auto is_leak = [](const StoredState& state) {
    return state.leak.class_ && *state.leak.class_ != LeakClass::normal;
  };
  const auto is_open = [](const StoredState& state) { return !state.leak.class_; };
  const bool leak = std::any_of(states.begin(), states.end(), is_leak);
  const auto open = std::count_if(states.begin(), states.end(), is_open);
  Json view = leak             ? make_headline("LEAK", "!", "warn", sentence)
              : states.empty() ? make_headline("NOT JUDGED", "○", "none", sentence)
              : open == 0      ? make_headline("NO LEAK", "✓", "good", sentence)
              : open == static_cast<std::ptrdiff_t>(states.size())
                  ? make_headline("NOT JUDGED", "○", "none", sentence)
                  : make_headline("UNCLEAR", "?", "warn", sentence);
  for (const StoredLeakTrend& trend : diagnosis.trends)
    if (trend.significant) add_reason(view, trend.sentence, "diagnosis");
  for (std::size_t i = 1; i < states.size(); ++i) add_reason(view, states[i].sentence, "diagnosis");
  return view;
}

std::string diagnosis_sentence(const StoredDiagnosis& diagnosis) {
  if (diagnosis.status == LeakStatus::declined)
    return "These records cannot be diagnosed: no leak below may be used.";
  if (diagnosis.status == LeakStatus::failed)
    return "No record could be diagnosed: no number below may be used.";
  const std::vector<StoredState> states = judged_states(diagnosis);
  if (states.size() == 1) return states.front().sentence;
  if (!states.empty()) {
    return fmt::format("Of {} states of the machine the worst: {}", states.size(),
                       states.front().sentence);
  }
  return "Every condition is the healthy reference of its signal: there is nothing to judge.";
}

}  // namespace

Json diagnosis_headline(const StoredDiagnosis& diagnosis) {
  const std::string sentence = diagnosis_sentence(diagnosis);
  if (diagnosis.status == LeakStatus::done) return headline_of_states(diagnosis, sentence);
  return headline_without_result(diagnosis.status, sentence, diagnosis.reasons, "diagnosis");
}

std::vector<Figure> diagnosis_figures(const StoredDiagnosis& diagnosis) {
  const auto& records = diagnosis.records;
  if (std::none_of(records.begin(), records.end(),
                   [](const auto& record) { return record.is_average(); }))
    return {};
  return {{"diagnosis", share_plot(diagnosis)}};
}

Json diagnosis_view(const StoredDiagnosis& diagnosis) {
  Json view;
  view["sentence"] = diagnosis_sentence(diagnosis);
  view["done"] = diagnosis.status == LeakStatus::done;
  view["reasons"] = diagnosis.reasons;
  view["classes"] = Json::array();
  view["averages"] = Json::array();
  view["repeats"] = Json::array();
  for (const StoredDiagnosedRecord& record : diagnosis.records) {
    if (view["classes"].empty()) {
      for (const auto& [name, value] : record.leak.class_probabilities)
        view["classes"].push_back(name);
    }
    Json& rows = view[record.is_average() ? "averages" : "repeats"];
    Json row = diagnosed_row(record, rows.size() + 1);
    rows.push_back(std::move(row));
  }
  view["states"] = Json::array();
  for (const StoredState& state : diagnosis.states) view["states"].push_back(state_row(state));
  view["has_states"] = !view["states"].empty();
  view["trends"] = Json::array();
  for (const StoredLeakTrend& trend : diagnosis.trends) view["trends"].push_back(trend.sentence);
  view["has_trends"] = !view["trends"].empty();
  view["has_records"] = !view["averages"].empty();
  view["has_repeats"] = !view["repeats"].empty();
  if (!view["averages"].empty()) view["plot_html"] = svg(share_plot(diagnosis));
  view["methods"] = methods_view(diagnosis.methods);
  view["has_methods"] = !view["methods"].empty();
  view["limits"] = Json::array();
  for (const StoredSmallestLeak& each : diagnosis.smallest_leak_l_per_min) {
    view["limits"].push_back({{"signal", each.signal},
                              {"single", shown_in(each.single, 1.0, 3)},
                              {"averaged", shown_in(each.averaged, 1.0, 3)},
                              {"share", shown_in(each.averaged_share_percent, 1.0, 3)},
                              {"reason", each.reason.value_or("")}});
  }
  view["has_limits"] = !view["limits"].empty();
  view["class_limits"] = class_limits_view(diagnosis);
  view["has_class_limits"] = !view["class_limits"].empty();
  view["false_alarms"] = fmt::format("{:g}", 100.0 * diagnosis.settings.false_alarms);
  view["detection"] = fmt::format("{:g}", 100.0 * diagnosis.settings.detection);
  view["warnings"] = diagnosis_warnings(diagnosis);
  view["has_warnings"] = !view["warnings"].empty();
  return view;
}

}  // namespace rigcal::report
