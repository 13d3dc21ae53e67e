#include "report/page/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/significant.hpp"
#include "datasets/record.hpp"
#include "metrics/metric_table.hpp"
#include "report/text/estimate_text.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// A number with all its digits, and as people read it.
Json exact_and(double value, std::string text) {
  return {{"exact", fmt::format("{}", value)}, {"text", std::move(text)}};
}

}  // namespace

Json shown_in(const Number& number, double si_per_unit, int digits) {
  if (!number.value) return {{"exact", ""}, {"text", "–"}};
  return exact_and(*number.value, significant(*number.value / si_per_unit, digits));
}

Json shown_interval(const Interval& interval, double si_per_unit) {
  const auto& ends = interval.ends;
  return shown_estimate(ends ? std::optional(0.5 * (ends->low + ends->high)) : std::nullopt,
                        interval, si_per_unit)
      .at("interval");
}

Json shown_estimate(const Number& number, const Interval& interval, double si_per_unit,
                    const Range& bounds) {
  const auto in_unit = [&](const Range& range) {
    return Range{range.low / si_per_unit, range.high / si_per_unit};
  };
  const Json missing{{"exact", ""}, {"text", "–"}};
  Json view{{"value", missing},
            {"interval", {{"known", false}, {"low", missing}, {"high", missing}}}};
  if (!number.value) return view;
  const auto& ends = interval.ends;
  const EstimateText text =
      estimate_text(*number.value / si_per_unit,
                    ends ? std::optional(in_unit(*ends)) : std::nullopt, in_unit(bounds));
  view["value"] = exact_and(*number.value, text.value);
  if (ends)
    view["interval"] = {{"known", true},
                        {"low", exact_and(ends->low, text.low)},
                        {"high", exact_and(ends->high, text.high)}};
  return view;
}

Json shown(const Number& number, std::string_view si_unit, int digits) {
  if (!number.value) return shown_in(number, 1.0, digits);
  return exact_and(*number.value, readable(*number.value, si_unit, digits));
}

Json shown_agreement(const Number& number) {
  if (!number.value) return shown_in(number, 1.0);
  return exact_and(*number.value, agreement_text(*number.value));
}

Json shown_score(const std::string& metric, const Number& number) {
  if (metric == "absolute_error_percent" || !number.value) return shown_in(number, 1.0, 4);
  const double v = *number.value;
  const double missing = std::abs(1.0 - v);
  const int decimals =
      missing > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(missing))) + 1, 3, 10) : 3;
  return exact_and(v, fmt::format("{:.{}f}", v, decimals));
}

RowUnit row_unit(double value_si, std::string_view si_unit) {
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

Json headline_without_result(LeakStatus status, const std::string& sentence,
                             const std::vector<std::string>& reasons, const std::string& link) {
  Json view =
      make_headline(status == LeakStatus::declined ? "DECLINED" : "FAILED", "✕", "bad", sentence);
  for (const std::string& reason : reasons) add_reason(view, reason, link);
  return view;
}

std::string grade_words(const std::optional<calib::Identifiability>& grade) {
  if (grade == calib::Identifiability::not_identifiable) return "not identifiable";
  return grade ? std::string(to_string(*grade)) : std::string();
}

bool is_doubtful(const std::optional<calib::Identifiability>& grade) {
  return grade && grade != calib::Identifiability::identified;
}

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

std::string anchor(const std::string& condition) { return "condition-" + condition; }

Json badge(const std::optional<calib::Verdict>& verdict) {
  if (!verdict) return {{"word", "not judged"}, {"mark", "○"}, {"class", "none"}};
  const std::string word(to_string(*verdict));
  switch (*verdict) {
    case calib::Verdict::pass:
      return {{"word", word}, {"mark", "✓"}, {"class", "good"}};
    case calib::Verdict::warn:
      return {{"word", word}, {"mark", "!"}, {"class", "warn"}};
    case calib::Verdict::fail:
      break;
  }
  return {{"word", word}, {"mark", "✕"}, {"class", "bad"}};
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

void add_interval(Trace& intervals, double x, const Interval& interval, double si_per_unit) {
  if (!interval.ends) return;
  intervals.x.push_back(x);
  intervals.y.push_back(interval.ends->low / si_per_unit);
  intervals.upper.push_back(interval.ends->high / si_per_unit);
}

std::string_view channel_unit(std::string_view channel) {
  const auto known = datasets::channel_from_key(channel);
  return known ? datasets::info(*known).unit : std::string_view("1");
}

}  // namespace rigcal::report
