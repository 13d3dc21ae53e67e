#include "report/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/record.hpp"
#include "metrics/metric_table.hpp"
#include "report/readable.hpp"

namespace rigcal::report {
namespace {

/// Where a metric is perfect.
double ideal_of(const metrics::MetricSpec& metric) {
  if (!metric.higher_is_better) return 0.0;
  return metric.unit == "%" ? 100.0 : 1.0;
}

const metrics::MetricSpec* metric_named(const std::string& name) {
  const auto found = std::find_if(metrics::kMetrics.begin(), metrics::kMetrics.end(),
                                  [&](const auto& spec) { return spec.name == name; });
  return found == metrics::kMetrics.end() ? nullptr : &*found;
}

}  // namespace

Json shown_in(const Json& value, double si_per_unit, int digits) {
  if (!value.is_number()) return {{"exact", ""}, {"text", "–"}};
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", significant(value.get<double>() / si_per_unit, digits)}};
}

Json shown_interval(const Json& pair, double si_per_unit, int digits) {
  const bool known = pair.is_array() && pair[0].is_number() && pair[1].is_number();
  if (known) {
    const double low = pair[0].get<double>();
    const double high = pair[1].get<double>();
    const double size = std::max(std::abs(low), std::abs(high));
    constexpr double kMostDigits = 12.0;  // beyond, the ends are one number
    const double needed = std::log10(size / (high - low)) + 2.0;
    if (high > low && needed < kMostDigits)
      digits = std::max(digits, static_cast<int>(std::ceil(needed)));
  }
  return {{"known", known},
          {"low", shown_in(known ? pair[0] : Json(), si_per_unit, digits)},
          {"high", shown_in(known ? pair[1] : Json(), si_per_unit, digits)}};
}

Json shown(const Json& value, std::string_view si_unit, int digits) {
  if (!value.is_number()) return shown_in(value, 1.0, digits);
  return {{"exact", fmt::format("{}", value.get<double>())},
          {"text", readable(value.get<double>(), si_unit, digits)}};
}

Json shown_agreement(const Json& value) {
  if (!value.is_number()) return shown_in(value, 1.0);
  const double v = value.get<double>();
  const double missing = std::abs(1.0 - v);
  const int decimals =
      missing > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(missing))) + 1, 3, 10) : 3;
  return {{"exact", fmt::format("{}", v)}, {"text", fmt::format("{:.{}f}", v, decimals)}};
}

Json shown_score(const std::string& metric, const Json& value) {
  return metric == "absolute_error_percent" ? shown_in(value, 1.0, 4) : shown_agreement(value);
}

RowUnit row_unit(double value_si, const Json& parameter) {
  const std::string si_unit = text_of(parameter, "unit");
  const ReadableUnit unit = readable_unit(value_si, si_unit);
  return {std::string(unit.name), unit.si};
}

std::string text_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? std::string() : found->get<std::string>();
}

std::optional<double> number_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
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
  if (!pair.is_array() || !pair[0].is_number() || !pair[1].is_number()) return;
  intervals.x.push_back(x);
  intervals.y.push_back(pair[0].get<double>() / si_per_unit);
  intervals.upper.push_back(pair[1].get<double>() / si_per_unit);
}

std::string_view channel_unit(std::string_view channel) {
  const auto known = datasets::channel_from_key(channel);
  return known ? datasets::info(*known).unit : std::string_view("1");
}

const Json& limits_of(const Json& result, const Json& condition) {
  const auto own = condition.find("acceptance");
  return own != condition.end() ? *own : result.at("acceptance");
}

Judgement judge_channel(const Json& limits, const Json& condition, const std::string& channel) {
  Judgement result;
  const auto worse = [&](const char* verdict) {
    constexpr std::array<std::string_view, 3> kOrder{"PASS", "WARN", "FAIL"};
    const auto rank = [&](std::string_view v) {
      return std::find(kOrder.begin(), kOrder.end(), v) - kOrder.begin();
    };
    if (!result.verdict || rank(verdict) > rank(*result.verdict)) result.verdict = verdict;
  };
  for (const Json& limit : limits) {
    if (text_of(limit, "channel") != channel) continue;
    worse("PASS");
    if (!text_of(condition, "failure").empty()) {
      worse("FAIL");
      continue;
    }
    const std::string name = text_of(limit, "metric");
    const metrics::MetricSpec* metric = metric_named(name);
    const auto value = number_of(condition.at("metrics").at(channel), name);
    if (metric == nullptr || !value) {
      worse("WARN");
      continue;
    }
    const double ideal = ideal_of(*metric);
    const auto excess = [&](double bound) {
      return std::abs(*value - ideal) / std::max(std::abs(bound - ideal), 1e-12);
    };
    const auto fail = number_of(limit, "limit");
    const auto warn = number_of(limit, "warn");
    const auto beyond = [&](const std::optional<double>& bound) {
      return bound && !(metric->higher_is_better ? *value >= *bound : *value <= *bound);
    };
    if (beyond(fail)) {
      worse("FAIL");
    } else if (beyond(warn)) {
      worse("WARN");
    }
    const auto bound = fail ? fail : warn;
    if (bound) result.excess = std::max(result.excess, excess(*bound));
  }
  return result;
}

}  // namespace rigcal::report
