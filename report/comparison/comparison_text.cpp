#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/comparison/comparison_parts.hpp"
#include "report/text/readable.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using Align = TextTable::Align;

std::string titled(const std::string& title, const std::string& body, const Style& style) {
  if (body.empty()) return {};
  const std::string head = wrapped(title, style.columns, 2);
  return (style.colour ? fmt::format("\x1b[1m{}\x1b[0m\n", head) : head + "\n") + body + "\n";
}

/// Names what a narrow terminal omits.
std::string narrow_note(const TextTable& table, std::size_t columns) {
  const std::vector<std::string> left_out = table.left_out(columns);
  if (left_out.empty()) return {};
  return wrapped(fmt::format("  columns hidden (narrow terminal): {}; see comparison.json",
                             fmt::join(left_out, ", ")),
                 columns, 2) +
         "\n";
}

std::string results_table(const StoredComparison& comparison, std::size_t columns) {
  TextTable table({{"result"},
                   {"model", Align::left, 2},
                   {"status"},
                   {"verdict"},
                   {"conditions", Align::right, 3},
                   {"dates"},
                   {"cost", Align::right, 1},
                   {"chi2 reduced", Align::right}});
  const auto number_text = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.5g}", *value) : std::string("-");
  };
  for (const StoredComparedResult& result : comparison.results) {
    std::string when = "-";
    if (const auto& dates = result.dates) {
      when = (*dates)[0];
      if ((*dates)[1] != (*dates)[0]) when += " .. " + (*dates)[1];
    }
    table.add({result.name, result.model ? std::string(to_string(*result.model)) : "-",
               std::string(to_string(result.status)),
               result.verdict ? std::string(to_string(*result.verdict)) : "-",
               fmt::format("{}", result.conditions), when, number_text(result.cost),
               number_text(result.reduced_chi_square)});
  }
  return table.text(columns) + narrow_note(table, columns);
}

/// "85.011 [84.96, 85.06]", "6.2 (known)", "-" in the unit of the row.
std::string estimate_text(const std::optional<StoredEstimate>& estimate, const RowUnit& unit) {
  if (!estimate || !estimate->value) return "-";
  const doc::Estimate shown = doc::estimate(estimate->value, estimate->ci95, unit.si);
  if (!estimate->fitted) return shown.value.text + " (known)";
  if (!shown.has_interval) return shown.value.text + " (no interval)";
  return fmt::format("{} [{}, {}]", shown.value.text, shown.low.text, shown.high.text);
}

std::string unit_text(const RowUnit& unit) { return unit.name.empty() ? "1" : unit.name; }

std::string difference_text(const std::optional<StoredDifference>& difference,
                            const RowUnit& unit) {
  const std::string text = difference ? change_text(*difference, unit) : std::string();
  if (text.empty()) return "-";
  if (const auto& p = difference->p_value_of_all)
    return text +
           fmt::format(" ({}){}", p_value_text(*p), difference->significant == true ? " *" : "");
  return difference->reason == kKnownInBoth ? text : text + " (not tested)";
}

/// A column per result.
TextTable wide_estimates(const StoredComparison& comparison) {
  const auto& results = comparison.results;
  std::vector<TextTable::Column> columns{{"parameter"}, {"unit"}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    columns.push_back({results[i].name, Align::right});
    if (i > 0) columns.push_back({"change", Align::right});
  }
  TextTable table(columns);
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    if (!worth_a_row(parameter)) continue;
    const RowUnit unit = unit_of_estimates(parameter);
    std::vector<std::string> row{parameter_label(parameter), unit_text(unit)};
    for (std::size_t i = 0; i < results.size(); ++i) {
      row.push_back(estimate_text(parameter.estimates.at(i), unit));
      if (i > 0) row.push_back(difference_text(parameter.differences.at(i), unit));
    }
    table.add(std::move(row));
  }
  return table;
}

/// A line per result under each parameter, for terminals that the other one does not fit on.
std::string stacked_estimates(const StoredComparison& comparison) {
  const auto& results = comparison.results;
  TextTable table({{"  result"}, {"value", Align::right}, {"change", Align::right}});
  std::vector<std::string> titles;
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    if (!worth_a_row(parameter)) continue;
    const RowUnit unit = unit_of_estimates(parameter);
    titles.push_back(fmt::format("{}, {}\n", parameter_label(parameter), unit_text(unit)));
    for (std::size_t i = 0; i < results.size(); ++i) {
      table.add({"  " + results[i].name, estimate_text(parameter.estimates.at(i), unit),
                 i > 0 ? difference_text(parameter.differences.at(i), unit) : std::string()});
    }
  }
  // The title of a parameter is above its lines; the line of the columns stays first.
  std::string text;
  std::size_t line = 0;
  const std::string all = table.text();
  for (std::size_t begin = 0; begin < all.size(); ++line) {
    const std::size_t end = all.find('\n', begin) + 1;
    if (line > 0 && (line - 1) % results.size() == 0) text += titles[(line - 1) / results.size()];
    text += all.substr(begin, end - begin);
    begin = end;
  }
  return text;
}

std::string estimates_table(const StoredComparison& comparison, std::size_t columns) {
  const TextTable wide = wide_estimates(comparison);
  if (wide.empty()) return {};
  return columns == 0 || wide.width() <= columns ? wide.text() : stacked_estimates(comparison);
}

/// Title of a metric as in the scorecard.
std::string metric_title(const std::string& metric) {
  return metric == "absolute_error_percent" ? "error %" : metric;
}

std::string sign_test_text(const StoredMetricAgainst& against) {
  if (!against.p_value) return "not tested";
  return p_value_text(*against.p_value) + (against.significant == true ? " *" : "");
}

std::string metrics_table(const StoredComparison& comparison, std::size_t columns) {
  TextTable table({{"channel"},
                   {"metric"},
                   {"result"},
                   {"conditions", Align::right, 2},
                   {"first", Align::right, 1},
                   {"mean", Align::right},
                   {"better", Align::right},
                   {"worse", Align::right},
                   {"sign test"}});
  for (const StoredComparedMetric& metric : comparison.metrics) {
    for (std::size_t i = 1; i < metric.against_first.size(); ++i) {
      const auto& against = metric.against_first[i];
      if (!against) continue;
      const auto mean_text = [&](double mean) { return doc::score(metric.metric, mean).text; };
      table.add({metric.channel, metric_title(metric.metric), comparison.results.at(i).name,
                 fmt::format("{}", against->conditions), mean_text(against->mean_of_first),
                 mean_text(against->mean), fmt::format("{}", against->better),
                 fmt::format("{}", against->worse), sign_test_text(*against)});
    }
  }
  return table.empty() ? std::string() : table.text(columns) + narrow_note(table, columns);
}

std::string models_text(const StoredComparison& comparison, std::size_t columns) {
  std::string text;
  for (std::size_t i = 1; i < comparison.models.size(); ++i) {
    const StoredModelChoice model = comparison.models[i].value_or(StoredModelChoice());
    const std::string reason = model.reason.value_or("");
    const std::string words =
        !model.verdict   ? "not compared: " + reason
        : reason.empty() ? *model.verdict
                         : fmt::format("{}; no likelihood ratio: {}", *model.verdict, reason);
    text += wrapped(fmt::format("  {}: {}", comparison.results.at(i).name, words), columns, 4);
    text += "\n";
  }
  return text;
}

std::string trend_line(const StoredSeries& series, const StoredTrend& trend, const char* per_unit,
                       std::size_t columns) {
  if (!trend.slope || !trend.ci95 || !trend.p_value) return {};
  return wrapped(fmt::format("  {}: {:+.3g} {} [{:.3g}, {:.3g}], {}{}, {} estimates", series.of,
                             *trend.slope, per_unit, trend.ci95->low, trend.ci95->high,
                             p_value_text(*trend.p_value), trend.significant == true ? " *" : "",
                             trend.points),
                 columns, 4) +
         "\n";
}

std::string trends_text(const StoredComparison& comparison, std::size_t columns) {
  std::string text;
  for (const StoredSeries& series : comparison.leak_trends) {
    text += trend_line(series, series.along_date, "per day", columns);
    text += trend_line(series, series.along_temperature, "per K", columns);
  }
  return text;
}

}  // namespace

std::string comparison_text(const StoredComparison& comparison, const Style& style) {
  const std::size_t columns = style.columns;
  std::string text = titled("Results", results_table(comparison, columns), style);
  text += titled(
      "Parameters with 95 % intervals; change from the first; * significant at 5 % for "
      "all parameters together (Holm)",
      estimates_table(comparison, columns), style);
  for (std::size_t i = 1; i < comparison.significance.size(); ++i) {
    const auto& each = comparison.significance[i];
    text += wrapped(
        fmt::format("{}: {}", comparison.results.at(i).name, each ? each->text : std::string()),
        columns, 2);
    text += "\n";
  }
  if (comparison.significance.size() > 1) text += "\n";
  text += titled(
      "Scores, mean over the conditions that both have, of the first and of the other; "
      "* significant at 5 %",
      metrics_table(comparison, columns), style);
  text += titled("Models, against the first", models_text(comparison, columns), style);
  text += titled("Trend of the leakage coefficient, 95 % intervals",
                 trends_text(comparison, columns), style);
  const auto shared =
      std::count_if(comparison.records.begin(), comparison.records.end(), [](const auto& record) {
        return std::all_of(record.in.begin(), record.in.end(), [](bool in) { return in; });
      });
  text += fmt::format("records: {} in all results, {} in some\n", shared,
                      static_cast<std::ptrdiff_t>(comparison.records.size()) - shared);
  for (const std::string& warning : comparison.warnings)
    text += wrapped("warning: " + warning, columns, 2) + "\n";
  text += fmt::format("status: {}\n", comparison.status);
  return text;
}

}  // namespace rigcal::report
