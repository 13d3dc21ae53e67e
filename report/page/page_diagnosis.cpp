#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/page/page_parts.hpp"
#include "report/text/gathered_warnings.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Verdict classes of the page for the classes of leaks, mildest first.
struct LeakMark {
  const char* name;
  const char* mark;
  const char* css;
};
constexpr std::array kLeakMarks{LeakMark{"normal", "✓", "good"}, LeakMark{"slight", "!", "warn"},
                                LeakMark{"medium", "!", "warn"}, LeakMark{"critical", "✕", "bad"},
                                LeakMark{"supercritical", "✕", "bad"}};

std::size_t severity(const std::string& name) {
  const auto found = std::find_if(kLeakMarks.begin(), kLeakMarks.end(),
                                  [&](const LeakMark& mark) { return mark.name == name; });
  return static_cast<std::size_t>(found - kLeakMarks.begin());
}

bool was_fitted(const Json& record) { return text_of(record, "failure").empty(); }

bool is_average(const Json& record) { return record.at("repeat").is_null(); }

Json leak_badge(const Json& record) {
  if (!was_fitted(record)) return {{"word", "not fitted"}, {"mark", "✕"}, {"class", "bad"}};
  const Json& explained = record.at("explained_by_leak");
  if (explained.is_boolean() && !explained.get<bool>())
    return {{"word", "not explained by a leak"}, {"mark", "✕"}, {"class", "bad"}};
  const std::string name = text_of(record, "class");
  const std::size_t index = severity(name);
  if (index == kLeakMarks.size()) return {{"word", "undecided"}, {"mark", "?"}, {"class", "none"}};
  return {{"word", name}, {"mark", kLeakMarks[index].mark}, {"class", kLeakMarks[index].css}};
}

Json probabilities_view(const Json& record) {
  Json cells = Json::array();
  for (const auto& [name, value] : record.at("class_probabilities").items()) {
    const double p = value.is_number() ? value.get<double>() : 0.0;
    Json cell{{"p", shown_in(value, 1.0, 3)}, {"strength", fmt::format("{:.2f}", p)}};
    if (value.is_number()) cell["p"]["text"] = fmt::format("{:.3f}", p);
    cells.push_back(std::move(cell));
  }
  return cells;
}

Json record_row(const Json& record, std::size_t number) {
  Json row;
  row["number"] = fmt::format("{}", number);
  row["condition"] = text_of(record, "condition");
  row["repeat"] =
      is_average(record) ? std::string() : fmt::format("{}", record.at("repeat").get<int>());
  row["badge"] = leak_badge(record);
  row["reference"] = record.at("is_reference").get<bool>();
  row["coefficient"] = shown_in(record.at("leakage_coefficient"), 1.0, 4);
  row["ci"] = shown_interval(record.at("ci95"), 1.0);
  row["share"] = shown_in(record.at("leak_share_percent"), 1.0, 4);
  row["share_ci"] = shown_interval(record.at("leak_share_ci95_percent"), 1.0);
  row["flow"] = shown_in(record.at("leak_flow_l_per_min"), 1.0, 3);
  row["probabilities"] = probabilities_view(record);
  row["by_features"] = text_of(record, "class_by_features");
  row["truth"] = text_of(record, "true_class");
  row["true_share"] = shown_in(record.at("true_share_percent"), 1.0, 4);
  row["failure"] = text_of(record, "failure");
  row["failed"] = !was_fitted(record);
  return row;
}

/// Shares with their intervals in the order of the table, and the limits of the classes.
Plot share_plot(const Json& diagnosis) {
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
  for (const Json& record : diagnosis.at("records")) {
    if (!is_average(record)) continue;
    number += 1.0;
    const auto share = number_of(record, "leak_share_percent");
    if (const auto truth = number_of(record, "true_share_percent")) {
      known.x.push_back(number);
      known.y.push_back(*truth);
    }
    if (!share) continue;
    middles.x.push_back(number);
    middles.y.push_back(*share);
    add_interval(spans, number, record.at("leak_share_ci95_percent"));
  }
  double most = 0.0;
  for (const double upper : spans.upper) most = std::max(most, upper);
  for (const double share : middles.y) most = std::max(most, share);
  for (const auto& [name, limit] : diagnosis.at("settings").at("limits_percent").items()) {
    if (limit.is_number() && limit.get<double>() > 0.0 && limit.get<double>() <= 1.2 * most)
      plot.levels.push_back(limit.get<double>());
  }
  plot.traces.push_back(std::move(spans));
  if (!known.x.empty()) plot.traces.push_back(std::move(known));
  plot.traces.push_back(std::move(middles));
  return plot;
}

Json confusion_view(const Json& confusion) {
  Json view{{"found", confusion.at("found")}, {"rows", Json::array()}};
  for (std::size_t i = 0; i < confusion.at("truth").size(); ++i) {
    long total = 0;
    for (const Json& count : confusion.at("counts").at(i)) total += as_count(count);
    if (total == 0) continue;
    Json cells = Json::array();
    for (std::size_t j = 0; j < confusion.at("counts").at(i).size(); ++j) {
      const long count = as_count(confusion.at("counts").at(i).at(j));
      cells.push_back({{"count", fmt::format("{}", count)},
                       {"sign", i == j ? "minus" : "plus"},
                       {"strength", fmt::format("{:.2f}", static_cast<double>(count) /
                                                              static_cast<double>(total))}});
    }
    view["rows"].push_back({{"truth", confusion.at("truth").at(i)}, {"cells", std::move(cells)}});
  }
  return view;
}

struct MethodName {
  const char* key;
  const char* name;
};
constexpr std::array kMethods{
    MethodName{"fitted_leak_single", "Fitted leak, single repeats"},
    MethodName{"fitted_leak_averaged", "Fitted leak, averages"},
    MethodName{"features_leave_one_repeat_out", "Paper's features, learned without the repeat"},
    MethodName{"features_leave_one_signal_out", "Paper's features, learned without the signal"}};

Json methods_view(const Json& diagnosis) {
  Json list = Json::array();
  for (const MethodName& each : kMethods) {
    const auto found = diagnosis.at("methods").find(each.key);
    if (found == diagnosis.at("methods").end()) continue;
    const Json& method = *found;
    if (method.at("records").get<int>() == 0) continue;
    const auto percent = [](const Json& value) {
      return shown_in(value.is_number() ? Json(100.0 * value.get<double>()) : Json(), 1.0, 4);
    };
    const Json& ci = method.at("accuracy_ci95");
    list.push_back({{"name", each.name},
                    {"right", fmt::format("{}", method.at("right").get<int>())},
                    {"records", fmt::format("{}", method.at("records").get<int>())},
                    {"conditions", fmt::format("{}", method.at("conditions").get<int>())},
                    {"undecided", fmt::format("{}", method.at("undecided").get<int>())},
                    {"off_by_two", fmt::format("{}", method.at("off_by_two_or_more").get<int>())},
                    {"accuracy", percent(method.at("accuracy"))},
                    {"low", percent(ci.is_array() ? ci.at(0) : Json())},
                    {"high", percent(ci.is_array() ? ci.at(1) : Json())},
                    {"confusion", confusion_view(method.at("confusion"))}});
  }
  return list;
}

/// Those of all; then of the records, each once.
Json diagnosis_warnings(const Json& diagnosis) {
  std::vector<std::pair<std::string, std::string>> told;
  for (const Json& record : diagnosis.at("records")) {
    const std::string name = text_of(record, "condition");
    for (const Json& warning : record.at("warnings")) {
      told.emplace_back(is_average(record)
                            ? name
                            : fmt::format("{} repeat {}", name, record.at("repeat").get<int>()),
                        warning.get<std::string>());
    }
  }
  Json list = Json::array();
  for (const Json& warning : diagnosis.at("warnings")) list.push_back(warning);
  for (const std::string& line : gathered_by_text(told)) list.push_back(line);
  return list;
}

/// Rows of the leak table that gave the limits; none where [diagnosis] did.
Json class_limits_view(const Json& diagnosis) {
  Json list = Json::array();
  if (!diagnosis.contains("class_limits")) return list;
  for (const Json& limit : diagnosis.at("class_limits")) {
    Json roots = Json::array();
    for (std::size_t i = 0; i < limit.at("coefficients").size(); ++i) {
      roots.push_back({{"value", shown_in(limit.at("coefficients").at(i), 1.0, 4)},
                       {"ci", shown_interval(limit.at("coefficients_ci95").at(i), 1.0)}});
    }
    list.push_back({{"signal", text_of(limit, "signal")},
                    {"share", shown_in(limit.at("share_percent"), 1.0, 4)},
                    {"class", text_of(limit, "class")},
                    {"roots", std::move(roots)}});
  }
  return list;
}

/// Verdicts on the states of the machine, but for healthy references; the largest leak first.
std::vector<Json> judged_states(const Json& diagnosis) {
  std::vector<Json> states;
  for (const Json& state : diagnosis.at("states"))
    if (!state.at("is_reference").get<bool>()) states.push_back(state);
  std::stable_sort(states.begin(), states.end(), [](const Json& a, const Json& b) {
    return number_of(a, "leak_share_percent").value_or(-1.0) >
           number_of(b, "leak_share_percent").value_or(-1.0);
  });
  return states;
}

Json state_badge(const Json& state) {
  if (state.at("is_reference").get<bool>())
    return {{"word", "reference"}, {"mark", "○"}, {"class", "none"}};
  const std::size_t index = severity(text_of(state, "class"));
  if (index < kLeakMarks.size())
    return {{"word", kLeakMarks[index].name},
            {"mark", kLeakMarks[index].mark},
            {"class", kLeakMarks[index].css}};
  const bool judged = state.at("leak_share_percent").is_number();
  return {{"word", judged ? "undecided" : "no verdict"}, {"mark", "?"}, {"class", "none"}};
}

std::string distance_text(const Json& limit) {
  if (!limit.is_object()) return "";
  const double points = limit.at("distance_percentage_points").get<double>();
  const std::string name = text_of(limit, "class");
  const double percent = limit.at("percent").get<double>();
  if (limit.at("on_limit").get<bool>()) return fmt::format("on that of {} ({:g} %)", name, percent);
  return fmt::format("{:.1f} points {} {} ({:g} %)", std::abs(points),
                     points < 0.0 ? "below" : "above", name, percent);
}

std::string agreement_text_of(const Json& agreement) {
  if (!agreement.is_object()) return "one signal";
  const std::string p = p_value_text(agreement.at("p").get<double>());
  return agreement.at("agree").get<bool>() ? fmt::format("agree ({})", p)
                                           : fmt::format("disagree ({})", p);
}

Json state_row(const Json& state) {
  Json row;
  row["state"] = text_of(state, "state");
  row["badge"] = state_badge(state);
  row["share"] = shown_in(state.at("leak_share_percent"), 1.0, 4);
  row["share_ci"] = shown_interval(state.at("leak_share_ci95_percent"), 1.0);
  row["duty"] = text_of(state, "duty");
  row["coefficient"] = shown_in(state.at("leakage_coefficient"), 1.0, 4);
  row["ci"] = shown_interval(state.at("ci95"), 1.0);
  row["area"] = shown_in(state.at("leak_area_m2"), 1e-6, 4);
  row["area_ci"] = shown_interval(state.at("leak_area_ci95_m2"), 1e-6);
  row["limit"] = distance_text(state.at("nearest_limit"));
  const bool is_reference = state.at("is_reference").get<bool>();
  row["agreement"] = is_reference ? std::string() : agreement_text_of(state.at("agreement"));
  row["left_out"] = state.at("left_out");
  row["has_left_out"] = !state.at("left_out").empty() && !is_reference;
  return row;
}

Json headline_of_states(const Json& diagnosis, const std::string& sentence) {
  const std::vector<Json> states = judged_states(diagnosis);
  const auto is_leak = [](const Json& state) {
    const std::size_t index = severity(text_of(state, "class"));
    return index > 0 && index < kLeakMarks.size();
  };
  const auto is_open = [](const Json& state) { return state.at("class").is_null(); };
  const bool leak = std::any_of(states.begin(), states.end(), is_leak);
  const auto open = std::count_if(states.begin(), states.end(), is_open);
  Json view = leak             ? make_headline("LEAK", "!", "warn", sentence)
              : states.empty() ? make_headline("NOT JUDGED", "○", "none", sentence)
              : open == 0      ? make_headline("NO LEAK", "✓", "good", sentence)
              : open == static_cast<std::ptrdiff_t>(states.size())
                  ? make_headline("NOT JUDGED", "○", "none", sentence)
                  : make_headline("UNCLEAR", "?", "warn", sentence);
  for (const Json& trend : diagnosis.at("trends")) {
    if (trend.at("significant").get<bool>())
      add_reason(view, text_of(trend, "sentence"), "diagnosis");
  }
  for (std::size_t i = 1; i < states.size(); ++i)
    add_reason(view, text_of(states[i], "sentence"), "diagnosis");
  return view;
}

std::string diagnosis_sentence(const Json& diagnosis) {
  const std::string status = text_of(diagnosis, "status");
  if (status == "declined") return "These records cannot be diagnosed: no leak below may be used.";
  if (status != "done") return "No record could be diagnosed: no number below may be used.";
  const std::vector<Json> states = judged_states(diagnosis);
  if (states.size() == 1) return text_of(states.front(), "sentence");
  if (!states.empty()) {
    return fmt::format("Of {} states of the machine the worst: {}", states.size(),
                       text_of(states.front(), "sentence"));
  }
  return "Every condition is the healthy reference of its signal: there is nothing to judge.";
}

}  // namespace

Json diagnosis_headline(const Json& diagnosis) {
  const std::string status = text_of(diagnosis, "status");
  const std::string sentence = diagnosis_sentence(diagnosis);
  if (status != "done") {
    Json view = make_headline(status == "declined" ? "DECLINED" : "FAILED", "✕", "bad", sentence);
    for (const Json& reason : diagnosis.at("reasons"))
      add_reason(view, reason.get<std::string>(), "diagnosis");
    return view;
  }
  return headline_of_states(diagnosis, sentence);
}

std::vector<Figure> diagnosis_figures(const Json& diagnosis) {
  const Json& records = diagnosis.at("records");
  if (std::none_of(records.begin(), records.end(), is_average)) return {};
  return {{"diagnosis", share_plot(diagnosis)}};
}

Json diagnosis_view(const Json& diagnosis) {
  const std::string status = text_of(diagnosis, "status");
  Json view;
  view["sentence"] = diagnosis_sentence(diagnosis);
  view["done"] = status == "done";
  view["reasons"] = diagnosis.at("reasons");
  view["classes"] = Json::array();
  view["averages"] = Json::array();
  view["repeats"] = Json::array();
  for (const Json& record : diagnosis.at("records")) {
    if (view["classes"].empty()) {
      for (const auto& [name, value] : record.at("class_probabilities").items())
        view["classes"].push_back(name);
    }
    Json& rows = view[is_average(record) ? "averages" : "repeats"];
    Json row = record_row(record, rows.size() + 1);
    rows.push_back(std::move(row));
  }
  view["states"] = Json::array();
  for (const Json& state : diagnosis.at("states")) view["states"].push_back(state_row(state));
  view["has_states"] = !view["states"].empty();
  view["trends"] = Json::array();
  for (const Json& trend : diagnosis.at("trends"))
    view["trends"].push_back(text_of(trend, "sentence"));
  view["has_trends"] = !view["trends"].empty();
  view["has_records"] = !view["averages"].empty();
  view["has_repeats"] = !view["repeats"].empty();
  if (!view["averages"].empty()) view["plot_html"] = svg(share_plot(diagnosis));
  view["methods"] = methods_view(diagnosis);
  view["has_methods"] = !view["methods"].empty();
  view["limits"] = Json::array();
  for (const Json& each : diagnosis.at("smallest_leak_l_per_min")) {
    view["limits"].push_back({{"signal", text_of(each, "signal")},
                              {"single", shown_in(each.at("single"), 1.0, 3)},
                              {"averaged", shown_in(each.at("averaged"), 1.0, 3)},
                              {"share", shown_in(each.at("averaged_share_percent"), 1.0, 3)},
                              {"reason", text_of(each, "reason")}});
  }
  view["has_limits"] = !view["limits"].empty();
  view["class_limits"] = class_limits_view(diagnosis);
  view["has_class_limits"] = !view["class_limits"].empty();
  const Json& settings = diagnosis.at("settings");
  view["false_alarms"] = fmt::format("{:g}", 100.0 * settings.at("false_alarms").get<double>());
  view["detection"] = fmt::format("{:g}", 100.0 * settings.at("detection").get<double>());
  view["warnings"] = diagnosis_warnings(diagnosis);
  view["has_warnings"] = !view["warnings"].empty();
  return view;
}

}  // namespace rigcal::report
