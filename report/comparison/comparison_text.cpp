#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// What a narrow terminal does not show.
std::string narrow_note(const TextTable& table, std::size_t columns) {
  const std::vector<std::string> left_out = table.left_out(columns);
  if (left_out.empty()) return {};
  return wrapped(fmt::format("  columns hidden (narrow terminal): {}; see comparison.json",
                             fmt::join(left_out, ", ")),
                 columns, 2) +
         "\n";
}

std::string results_table(const Json& comparison, std::size_t columns) {
  TextTable table({{"result"},
                   {"model", Align::left, 2},
                   {"status"},
                   {"verdict"},
                   {"conditions", Align::right, 3},
                   {"dates"},
                   {"cost", Align::right, 1},
                   {"chi2 reduced", Align::right}});
  for (const Json& result : comparison.at("results")) {
    const Json& dates = result.at("dates");
    const auto number_text = [&](const char* key) {
      const auto value = number_of(result, key);
      return value ? fmt::format("{:.5g}", *value) : std::string("-");
    };
    const std::string verdict = text_of(result, "verdict");
    std::string when = "-";
    if (dates.is_array()) {
      when = dates[0].get<std::string>();
      if (dates[1] != dates[0]) when += " .. " + dates[1].get<std::string>();
    }
    const std::string model = text_of(result, "model");
    table.add({text_of(result, "name"), model.empty() ? "-" : model, text_of(result, "status"),
               verdict.empty() ? "-" : verdict,
               fmt::format("{}", result.at("conditions").get<int>()), when, number_text("cost"),
               number_text("reduced_chi_square")});
  }
  return table.text(columns) + narrow_note(table, columns);
}

/// "85.011 [84.96, 85.06]", "6.2 (known)", "-" in the unit of the row.
std::string estimate_text(const Json& estimate, const RowUnit& unit) {
  if (!estimate.is_object() || !number_of(estimate, "value")) return "-";
  const std::string text =
      text_of(shown_matched(estimate.at("value"), estimate.at("ci95"), unit.si, 6), "text");
  if (!estimate.at("fitted").get<bool>()) return text + " (known)";
  const Json interval = shown_interval(estimate.at("ci95"), unit.si);
  if (!interval.at("known").get<bool>()) return text + " (no interval)";
  return fmt::format("{} [{}, {}]", text, text_of(interval.at("low"), "text"),
                     text_of(interval.at("high"), "text"));
}

std::string unit_text(const RowUnit& unit) { return unit.name.empty() ? "1" : unit.name; }

std::string difference_text(const Json& difference, const RowUnit& unit) {
  if (!difference.is_object()) return "-";
  const std::string text = change_text(difference, unit);
  if (text.empty()) return "-";
  if (const auto p = number_of(difference, "p_value_of_all")) {
    return text + fmt::format(" ({}){}", p_value_text(*p),
                              difference.at("significant").get<bool>() ? " *" : "");
  }
  return difference.at("reason") == kKnownInBoth ? text : text + " (not tested)";
}

/// A column per result.
TextTable wide_estimates(const Json& comparison) {
  const Json& results = comparison.at("results");
  std::vector<TextTable::Column> columns{{"parameter"}, {"unit"}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    columns.push_back({text_of(results[i], "name"), Align::right});
    if (i > 0) columns.push_back({"change", Align::right});
  }
  TextTable table(columns);
  for (const Json& parameter : comparison.at("parameters")) {
    if (!worth_a_row(parameter)) continue;
    const Json& estimates = parameter.at("estimates");
    const RowUnit unit = unit_of_estimates(parameter);
    std::vector<std::string> row{parameter_label(parameter), unit_text(unit)};
    for (std::size_t i = 0; i < estimates.size(); ++i) {
      row.push_back(estimate_text(estimates[i], unit));
      if (i > 0) row.push_back(difference_text(parameter.at("differences").at(i), unit));
    }
    table.add(std::move(row));
  }
  return table;
}

/// A line per result under each parameter, for terminals that the other one does not fit on.
std::string stacked_estimates(const Json& comparison) {
  const Json& results = comparison.at("results");
  TextTable table({{"  result"}, {"value", Align::right}, {"change", Align::right}});
  std::vector<std::string> titles;
  for (const Json& parameter : comparison.at("parameters")) {
    if (!worth_a_row(parameter)) continue;
    const RowUnit unit = unit_of_estimates(parameter);
    titles.push_back(fmt::format("{}, {}\n", parameter_label(parameter), unit_text(unit)));
    for (std::size_t i = 0; i < results.size(); ++i) {
      table.add({"  " + text_of(results[i], "name"),
                 estimate_text(parameter.at("estimates").at(i), unit),
                 i > 0 ? difference_text(parameter.at("differences").at(i), unit) : std::string()});
    }
  }
  // The title of a parameter goes above its lines; the line of the columns stays first.
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

std::string estimates_table(const Json& comparison, std::size_t columns) {
  const TextTable wide = wide_estimates(comparison);
  if (wide.empty()) return {};
  return columns == 0 || wide.width() <= columns ? wide.text() : stacked_estimates(comparison);
}

/// As the scorecard calls them.
std::string metric_title(const std::string& metric) {
  return metric == "absolute_error_percent" ? "error %" : metric;
}

std::string sign_test_text(const Json& against) {
  const auto p = number_of(against, "p_value");
  if (!p) return "not tested";
  return p_value_text(*p) + (against.at("significant").get<bool>() ? " *" : "");
}

std::string metrics_table(const Json& comparison, std::size_t columns) {
  TextTable table({{"channel"},
                   {"metric"},
                   {"result"},
                   {"conditions", Align::right, 2},
                   {"first", Align::right, 1},
                   {"mean", Align::right},
                   {"better", Align::right},
                   {"worse", Align::right},
                   {"sign test"}});
  for (const Json& metric : comparison.at("metrics")) {
    const Json& against = metric.at("against_first");
    for (std::size_t i = 1; i < against.size(); ++i) {
      if (!against[i].is_object()) continue;
      const auto mean_text = [&](const char* key) {
        return text_of(shown_score(text_of(metric, "metric"), against[i].at(key)), "text");
      };
      table.add({text_of(metric, "channel"), metric_title(text_of(metric, "metric")),
                 text_of(comparison.at("results").at(i), "name"),
                 fmt::format("{}", against[i].at("conditions").get<int>()),
                 mean_text("mean_of_first"), mean_text("mean"),
                 fmt::format("{}", against[i].at("better").get<int>()),
                 fmt::format("{}", against[i].at("worse").get<int>()), sign_test_text(against[i])});
    }
  }
  return table.empty() ? std::string() : table.text(columns) + narrow_note(table, columns);
}

std::string models_text(const Json& comparison, std::size_t columns) {
  std::string text;
  const Json& models = comparison.at("models");
  for (std::size_t i = 1; i < models.size(); ++i) {
    const std::string verdict = text_of(models[i], "verdict");
    const std::string reason = text_of(models[i], "reason");
    const std::string words = verdict.empty() ? "not compared: " + reason
                              : reason.empty()
                                  ? verdict
                                  : fmt::format("{}; no likelihood ratio: {}", verdict, reason);
    text += wrapped(fmt::format("  {}: {}", text_of(comparison.at("results").at(i), "name"), words),
                    columns, 4);
    text += "\n";
  }
  return text;
}

std::string trends_text(const Json& comparison, std::size_t columns) {
  std::string text;
  for (const Json& trend : comparison.at("leak_trends")) {
    for (const auto& [key, slope, unit] :
         {std::tuple{"along_date", "slope_per_day", "per day"},
          std::tuple{"along_temperature", "slope_per_k", "per K"}}) {
      const Json& along = trend.at(key);
      const auto value = number_of(along, slope);
      if (!value) continue;
      const Json& ci = along.at("ci95");
      text +=
          wrapped(fmt::format("  {}: {:+.3g} {} [{:.3g}, {:.3g}], {}{}, {} estimates",
                              text_of(trend, "of"), *value, unit, ci[0].get<double>(),
                              ci[1].get<double>(), p_value_text(along.at("p_value").get<double>()),
                              along.at("significant").get<bool>() ? " *" : "",
                              along.at("points").get<int>()),
                  columns, 4);
      text += "\n";
    }
  }
  return text;
}

std::string made_text(const Json& comparison, const Style& style) {
  const std::size_t columns = style.columns;
  std::string text = titled("Results", results_table(comparison, columns), style);
  text += titled(
      "Parameters with 95 % intervals; change from the first; * significant at 5 % for "
      "all parameters together (Holm)",
      estimates_table(comparison, columns), style);
  for (std::size_t i = 1; i < comparison.at("significance").size(); ++i) {
    text += wrapped(fmt::format("{}: {}", text_of(comparison.at("results").at(i), "name"),
                                text_of(comparison.at("significance").at(i), "text")),
                    columns, 2) +
            "\n";
  }
  if (comparison.at("significance").size() > 1) text += "\n";
  text += titled(
      "Scores, mean over the conditions that both have, of the first and of the other; "
      "* significant at 5 %",
      metrics_table(comparison, columns), style);
  text += titled("Models, against the first", models_text(comparison, columns), style);
  text += titled("Trend of the leakage coefficient, 95 % intervals",
                 trends_text(comparison, columns), style);
  int shared = 0;
  for (const Json& record : comparison.at("records")) {
    bool everywhere = true;
    for (const Json& in : record.at("in")) everywhere = everywhere && in.get<bool>();
    shared += everywhere ? 1 : 0;
  }
  text += fmt::format("records: {} in all results, {} in some\n", shared,
                      comparison.at("records").size() - static_cast<std::size_t>(shared));
  for (const Json& warning : comparison.at("warnings"))
    text += wrapped("warning: " + warning.get<std::string>(), columns, 2) + "\n";
  text += fmt::format("status: {}\n", text_of(comparison, "status"));
  return text;
}

}  // namespace

std::string comparison_text(const Json& comparison, const Style& style) {
  std::string text;
  with_json_errors("comparison", [&] { text = made_text(comparison, style); });
  return text;
}

}  // namespace rigcal::report
