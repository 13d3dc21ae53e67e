#include "report/page/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/significant.hpp"
#include "datasets/record.hpp"
#include "metrics/metric_table.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
Json shown_in(const Json& value, double si_per_unit, int digits) {
  if (!value.is_number()) return {{"exact", ""}, {"text", "–"}};
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", significant(value.get<double>() / si_per_unit, digits)}};
}

Json shown_interval(const Json& pair, double si_per_unit) {
  const bool known = pair.is_array() && pair.at(0).is_number() && pair.at(1).is_number();
  constexpr int kDigits = 5;
  return {{"known", known},
          {"low", shown_matched(known ? pair.at(0) : Json(), pair, si_per_unit, kDigits)},
          {"high", shown_matched(known ? pair.at(1) : Json(), pair, si_per_unit, kDigits)}};
}

Json shown(const Json& value, std::string_view si_unit, int digits) {
  if (!value.is_number()) return shown_in(value, 1.0, digits);
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", readable(value.get<double>(), si_unit, digits)}};
}

Json shown_agreement(const Json& value) {
  if (!value.is_number()) return shown_in(value, 1.0);
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", agreement_text(value.get<double>())}};
}

Json shown_score(const std::string& metric, const Json& value) {
  if (metric == "absolute_error_percent" || !value.is_number()) return shown_in(value, 1.0, 4);
  const double v = value.get<double>();
  const double missing = std::abs(1.0 - v);
  const int decimals =
      missing > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(missing))) + 1, 3, 10) : 3;
  return {{"exact", fmt::format("{}", v)}, {"text", fmt::format("{:.{}f}", v, decimals)}};
}

Json shown_matched(const Json& value, const Json& interval, double si_per_unit, int digits) {
  const bool known =
      interval.is_array() && interval.at(0).is_number() && interval.at(1).is_number();
  if (!value.is_number() || !known) return shown_in(value, si_per_unit, digits);
  const double half = 0.5 * (interval.at(1).get<double>() - interval.at(0).get<double>());
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", matched(value.get<double>() / si_per_unit, half / si_per_unit)}};
}

RowUnit row_unit(double value_si, const Json& parameter) {
  const std::string si_unit = text_of(parameter, "unit");
  const ReadableUnit unit = readable_unit(value_si, si_unit);
  return {std::string(unit.name), unit.si};
}

Json make_headline(const std::string& word, const std::string& mark, const std::string& css,
                   const std::string& sentence) {
  return {{"word", word},
          {"mark", mark},
          {"class", css},
          {"sentence", sentence},
          {"reasons", Json::array()},
          {"has_more", false},
          {"more", 0}};
}

void add_reason(Json& headline, const std::string& text, const std::string& link) {
  constexpr std::size_t kReasonsShown = 3;
  if (headline["reasons"].size() < kReasonsShown) {
    headline["reasons"].push_back({{"text", text}, {"link", link}, {"linked", !link.empty()}});
    return;
  }
  headline["has_more"] = true;
  headline["more"] = headline["more"].get<int>() + 1;
}

std::string anchor(const std::string& condition) { return "condition-" + condition; }

Json badge(const Json& verdict) {
  if (!verdict.is_string()) return {{"word", "not judged"}, {"mark", "○"}, {"class", "none"}};
  const auto word = verdict.get<std::string>();
  if (word == "PASS") return {{"word", word}, {"mark", "✓"}, {"class", "good"}};
  if (word == "WARN") return {{"word", word}, {"mark", "!"}, {"class", "warn"}};
  return {{"word", word}, {"mark", "✕"}, {"class", "bad"}};
}

std::string parameter_label(const Json& parameter) {
  const std::string level = text_of(parameter, "level");
  const std::string key = parameter.at("key").get<std::string>();
  if (level.empty()) return key;
  const bool leak = text_of(parameter, "scope") == "leak_level";
  return fmt::format("{} ({} {})", key, leak ? "leak level" : "condition", level);
}

Plot ranked_points(const std::string& title, const std::string& y_label,
                   const std::vector<double>& values) {
  Plot plot;
  plot.title = title;
  plot.y_label = y_label;
  plot.whole_x = true;
  plot.log_y = true;
  plot.height = 170.0;
  Trace trace = empty_trace(Trace::Kind::points, "model");
  for (const double value : values) {
    trace.x.push_back(static_cast<double>(trace.x.size() + 1));
    trace.y.push_back(value);
  }
  plot.traces = {std::move(trace)};
  return plot;
}

void add_interval(Trace& intervals, double x, const Json& pair, double si_per_unit) {
  if (!pair.is_array() || !pair.at(0).is_number() || !pair.at(1).is_number()) return;
  intervals.x.push_back(x);
  intervals.y.push_back(pair.at(0).get<double>() / si_per_unit);
  intervals.upper.push_back(pair.at(1).get<double>() / si_per_unit);
}

std::string_view channel_unit(std::string_view channel) {
  const auto known = datasets::channel_from_key(channel);
  return known ? datasets::info(*known).unit : std::string_view("1");
}

Json channel_verdict(const Json& condition, const std::string& channel) {
  if (!text_of(condition, "failure").empty()) return condition.at("verdict");
  const auto verdicts = condition.find("channel_verdicts");
  if (verdicts == condition.end()) return nullptr;
  const auto found = verdicts->find(channel);
  return found == verdicts->end() ? Json(nullptr) : *found;
}

}  // namespace rigcal::report
