#include <fmt/format.h>

#include <cmath>

#include "report/comparison.hpp"
#include "report/page_parts.hpp"
#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace rigcal::report {
namespace {

using Align = TextTable::Align;

std::string titled(const std::string& title, const std::string& body, const Style& style) {
  if (body.empty()) return {};
  return (style.colour ? fmt::format("\x1b[1m{}\x1b[0m\n", title) : title + "\n") + body + "\n";
}

std::string results_table(const Json& comparison) {
  TextTable table({{"result"},
                   {"model"},
                   {"status"},
                   {"verdict"},
                   {"conditions", Align::right},
                   {"dates"},
                   {"cost", Align::right},
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
  return table.text();
}

/// "85.011 ± 0.052", "6.2 (known)", "-" in the unit of the row.
std::string estimate_text(const Json& estimate, const RowUnit& unit) {
  if (!estimate.is_object()) return "-";
  const auto value = number_of(estimate, "value");
  if (!value) return "-";
  const std::string text = fmt::format("{:.5g}", *value / unit.si);
  if (!estimate.at("fitted").get<bool>()) return text + " (known)";
  const Json& ci = estimate.at("ci95");
  if (!ci.is_array() || !ci[0].is_number() || !ci[1].is_number()) return text + " (no interval)";
  return fmt::format("{} [{:.5g}, {:.5g}]", text, ci[0].get<double>() / unit.si,
                     ci[1].get<double>() / unit.si);
}

std::string difference_text(const Json& difference) {
  if (!difference.is_object()) return "-";
  const auto percent = number_of(difference, "percent");
  if (!percent) return "-";
  std::string text = fmt::format("{:+.3g} %", *percent);
  if (const auto p = number_of(difference, "p_value_of_all")) {
    text += fmt::format(" ({}){}", p_value_text(*p),
                        difference.at("significant").get<bool>() ? " *" : "");
  }
  return text;
}

bool anything_fitted(const Json& parameter) {
  for (const Json& estimate : parameter.at("estimates"))
    if (estimate.is_object() && estimate.at("fitted").get<bool>()) return true;
  return false;
}

/// Known values that differ belong to what differs too.
bool worth_a_row(const Json& parameter) {
  if (anything_fitted(parameter)) return true;
  for (const Json& difference : parameter.at("differences")) {
    if (difference.is_object() && number_of(difference, "difference").value_or(0.0) != 0.0)
      return true;
  }
  return false;
}

std::string estimates_table(const Json& comparison) {
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
    double size = 0.0;
    for (const Json& estimate : estimates) {
      if (estimate.is_object())
        size = std::max(size, std::abs(number_of(estimate, "value").value_or(0.0)));
    }
    const RowUnit unit = row_unit(size, parameter);
    std::vector<std::string> row{parameter_label(parameter),
                                 unit.name.empty() ? std::string("1") : unit.name};
    for (std::size_t i = 0; i < estimates.size(); ++i) {
      row.push_back(estimate_text(estimates[i], unit));
      if (i > 0) row.push_back(difference_text(parameter.at("differences")[i]));
    }
    table.add(std::move(row));
  }
  return table.empty() ? std::string() : table.text();
}

std::string metrics_table(const Json& comparison) {
  TextTable table({{"channel"},
                   {"metric"},
                   {"result"},
                   {"conditions", Align::right},
                   {"mean of first", Align::right},
                   {"mean", Align::right},
                   {"better", Align::right},
                   {"worse", Align::right},
                   {"sign test"}});
  for (const Json& metric : comparison.at("metrics")) {
    const Json& against = metric.at("against_first");
    for (std::size_t i = 1; i < against.size(); ++i) {
      if (!against[i].is_object()) continue;
      const auto mean_text = [&](const char* key) {
        const auto value = number_of(against[i], key);
        return value ? fmt::format("{:.6g}", *value) : std::string("-");
      };
      table.add({text_of(metric, "channel"), text_of(metric, "metric"),
                 text_of(comparison.at("results")[i], "name"),
                 fmt::format("{}", against[i].at("conditions").get<int>()),
                 mean_text("mean_of_first"), mean_text("mean"),
                 fmt::format("{}", against[i].at("better").get<int>()),
                 fmt::format("{}", against[i].at("worse").get<int>()),
                 p_value_text(against[i].at("p_value").get<double>()) +
                     (against[i].at("significant").get<bool>() ? " *" : "")});
    }
  }
  return table.empty() ? std::string() : table.text();
}

std::string models_text(const Json& comparison) {
  std::string text;
  const Json& models = comparison.at("models");
  for (std::size_t i = 1; i < models.size(); ++i) {
    const std::string verdict = text_of(models[i], "verdict");
    const std::string reason = text_of(models[i], "reason");
    text +=
        fmt::format("  {}: {}\n", text_of(comparison.at("results")[i], "name"),
                    verdict.empty()  ? "not compared: " + reason
                    : reason.empty() ? verdict
                                     : fmt::format("{}; no likelihood ratio: {}", verdict, reason));
  }
  return text;
}

std::string trends_text(const Json& comparison) {
  std::string text;
  for (const Json& trend : comparison.at("leak_trends")) {
    for (const auto& [key, slope, unit] :
         {std::tuple{"along_date", "slope_per_day", "per day"},
          std::tuple{"along_temperature", "slope_per_k", "per K"}}) {
      const Json& along = trend.at(key);
      const auto value = number_of(along, slope);
      if (!value) continue;
      text += fmt::format(
          "  {}: {:+.3g} {} [{:.3g}, {:.3g}], {}{}, {} estimates\n", text_of(trend, "of"), *value,
          unit, along.at("ci95")[0].get<double>(), along.at("ci95")[1].get<double>(),
          p_value_text(along.at("p_value").get<double>()),
          along.at("significant").get<bool>() ? " *" : "", along.at("points").get<int>());
    }
  }
  return text;
}

}  // namespace

std::string comparison_text(const Json& comparison, const Style& style) {
  std::string text = titled("Results", results_table(comparison), style);
  text += titled(
      "Parameters with 95 % intervals; change from the first; * significant at 5 % for "
      "all parameters together (Holm)",
      estimates_table(comparison), style);
  text += titled("Scores over the conditions that both have; * significant at 5 %",
                 metrics_table(comparison), style);
  text += titled("Models, against the first", models_text(comparison), style);
  text +=
      titled("Trend of the leakage coefficient, 95 % intervals", trends_text(comparison), style);
  int shared = 0;
  for (const Json& record : comparison.at("records")) {
    bool everywhere = true;
    for (const Json& in : record.at("in")) everywhere = everywhere && in.get<bool>();
    shared += everywhere ? 1 : 0;
  }
  text += fmt::format("records: {} in all results, {} in some\n", shared,
                      comparison.at("records").size() - static_cast<std::size_t>(shared));
  for (const Json& warning : comparison.at("warnings"))
    text += fmt::format("warning: {}\n", warning.get<std::string>());
  text += fmt::format("status: {}\n", text_of(comparison, "status"));
  return text;
}

}  // namespace rigcal::report
