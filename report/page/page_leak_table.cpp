#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/figure/decimate.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kLevelPoints = 1200;
/// Half an interval in parts of its middle, from which on its two ends are shown.
constexpr double kWideInterval = 0.1;
/// Classes of the style sheet for levels side by side, told apart without colour by their order.
constexpr std::array kLevelStyles{"model", "residual", "servo", "leak", "reference"};

std::string drive_name(const Json& entry) {
  std::string text = fmt::format("{:.6g} Hz {}", number_of(entry, "frequency_hz").value_or(0.0),
                                 text_of(entry, "waveform"));
  if (const auto amplitude = number_of(entry, "amplitude_m"))
    text += ", " + readable(*amplitude, "m", 4);
  if (const auto amplitude = number_of(entry, "amplitude_v"))
    text += ", " + readable(*amplitude, "V", 4);
  return text;
}

Json grade_badge(const std::string& grade) {
  if (grade == "within 10 %") return {{"word", grade}, {"mark", "✓"}, {"class", "good"}};
  if (grade == "within 16 %") return {{"word", grade}, {"mark", "!"}, {"class", "warn"}};
  if (grade == "outlier") return {{"word", grade}, {"mark", "✕"}, {"class", "bad"}};
  return {{"word", grade}, {"mark", ""}, {"class", "none"}};
}

/// All roots of an entry; "~" before those that the share hardly determines.
std::string coefficients_text(const Json& entry) {
  std::string text;
  for (const Json& root : entry.at("coefficients")) {
    if (!root.is_number()) continue;
    text += fmt::format("{}{}{:.3g}", text.empty() ? "" : ", ",
                        entry.at("determined").get<bool>() ? "" : "~", root.get<double>());
  }
  return text.empty() ? "no coefficient" : text;
}

/// Their intervals; results without a fit, or of before there were any, have none.
std::string intervals_text(const Json& entry) {
  std::string text;
  if (!entry.contains("coefficients_ci95")) return text;
  for (const Json& range : entry.at("coefficients_ci95")) {
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number())
      continue;
    const double low = range[0].get<double>();
    const double high = range[1].get<double>();
    const double half = (high - low) / (high + low);
    text += text.empty() ? "" : ", ";
    text += half < kWideInterval ? fmt::format("±{:.2g} %", 100.0 * half)
                                 : fmt::format("{:.3g} … {:.3g}", low, high);
  }
  return text;
}

Json leak_cell(const Json& entry) {
  const bool published = entry.at("published_coefficient").is_number();
  Json cell;
  cell["coefficients"] = coefficients_text(entry);
  cell["roots"] = Json::array();
  for (const Json& root : entry.at("coefficients"))
    cell["roots"].push_back({{"exact", shown_in(root, 1.0).at("exact")}});
  cell["interval"] = intervals_text(entry);
  cell["has_interval"] = !cell["interval"].get_ref<const std::string&>().empty();
  cell["published"] = published;
  cell["badge"] = grade_badge(text_of(entry, "grade"));
  if (!published) return cell;
  cell["published_coefficient"] = shown_in(entry.at("published_coefficient"), 1.0, 6);
  const auto error = number_of(entry, "relative_error_percent");
  cell["error"] = error ? fmt::format("{:+.1f} %", *error) : std::string("–");
  cell["share"] = shown_in(entry.at("share_at_published_percent"), 1.0, 3);
  const Json& range = entry.at("share_by_rounding_percent");
  cell["has_range"] = range.is_array();
  if (range.is_array()) {
    cell["range_low"] = shown_in(range.at(0), 1.0, 3);
    cell["range_high"] = shown_in(range.at(1), 1.0, 3);
  }
  return cell;
}

/// Signals by target shares, in the order of the file.
Json leak_rows(const Json& entries, const std::vector<double>& targets) {
  std::vector<std::string> names;
  for (const Json& entry : entries) {
    const std::string name = drive_name(entry);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  Json rows = Json::array();
  for (const std::string& name : names) {
    Json cells = Json::array();
    for (const double target : targets) {
      Json cell{{"there", false}};
      for (const Json& entry : entries) {
        if (drive_name(entry) != name || number_of(entry, "target_percent") != target) continue;
        cell = leak_cell(entry);
        cell["there"] = true;
      }
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"signal", name}, {"cells", std::move(cells)}});
  }
  return rows;
}

std::vector<double> targets_of(const Json& entries) {
  std::vector<double> targets;
  for (const Json& entry : entries) {
    const double target = entry.at("target_percent").get<double>();
    if (std::find(targets.begin(), targets.end(), target) == targets.end())
      targets.push_back(target);
  }
  return targets;
}

/// Computed over published coefficients; what is met lies on the line.
Plot agreement_plot(const Json& entries) {
  Plot plot;
  plot.title = "Computed over published leakage coefficients";
  plot.x_label = "published coefficient";
  plot.y_label = "computed coefficient";
  plot.log_x = plot.log_y = true;
  plot.width = 460.0;
  plot.height = 320.0;
  double low = HUGE_VAL;
  double high = 0.0;
  Trace met = empty_trace(Trace::Kind::points, "model", "within 16 %");
  Trace outliers = empty_trace(Trace::Kind::points, "residual", "outlier");
  for (const Json& entry : entries) {
    const auto published = number_of(entry, "published_coefficient");
    if (!published || *published <= 0.0) continue;
    Trace& into = text_of(entry, "grade") == "outlier" ? outliers : met;
    double nearest = std::nan("");
    for (const Json& root : entry.at("coefficients")) {
      if (!root.is_number()) continue;
      const double value = root.get<double>();
      if (std::isnan(nearest) ||
          std::abs(std::log(value / *published)) < std::abs(std::log(nearest / *published)))
        nearest = value;
    }
    if (std::isnan(nearest)) continue;
    into.x.push_back(*published);
    into.y.push_back(nearest);
    low = std::min({low, *published, nearest});
    high = std::max({high, *published, nearest});
  }
  if (high > 0.0) {
    Trace equal = empty_trace(Trace::Kind::line, "reference", "equal");
    equal.x = equal.y = {low, high};
    plot.traces.push_back(std::move(equal));
  }
  for (Trace* trace : {&met, &outliers})
    if (!trace->x.empty()) plot.traces.push_back(std::move(*trace));
  return plot;
}

Json against_published(const Json& row, const std::string& name) {
  const auto computed = number_of(row, name);
  const auto published = number_of(row, "published_" + name);
  Json cell{{"computed", shown_in(row.at(name), 1.0, 4)}, {"published", published.has_value()}};
  if (!published) return cell;
  cell["published_value"] = shown_in(row.at("published_" + name), 1.0, 4);
  cell["error"] = computed && *published != 0.0
                      ? fmt::format("{:+.1f} %", 100.0 * (*computed / *published - 1.0))
                      : std::string("–");
  return cell;
}

Json feature_rows(const Json& features) {
  Json rows = Json::array();
  for (const Json& feature : features) {
    Json cells = Json::array();
    for (const char* name : {"servo_flow_l_per_min", "leak_flow_l_per_min", "mean", "rms", "std"})
      cells.push_back(against_published(feature, name));
    rows.push_back({{"level", text_of(feature, "level")},
                    {"coefficient", shown_in(feature.at("coefficient"), 1.0, 4)},
                    {"cells", std::move(cells)},
                    {"reason", text_of(feature, "reason")},
                    {"has_reason", !text_of(feature, "reason").empty()}});
  }
  return rows;
}

Plot levels_plot(const std::vector<std::pair<std::string, Table>>& levels) {
  Plot plot;
  plot.title = "Position without the leak minus position with it, over one period";
  plot.x_label = "time [s]";
  double size = 0.0;
  for (const auto& [level, table] : levels) {
    const auto* residual = table.find("residual_m");
    const auto* time_s = table.find("time_s");
    if (residual == nullptr || time_s == nullptr || residual->empty()) continue;
    const Buckets thin = buckets(residual->size(), kLevelPoints);
    Trace trace;
    trace.name = level;
    trace.style = kLevelStyles[std::min(plot.traces.size(), kLevelStyles.size() - 1)];
    trace.x = thinned_times(*time_s, thin);
    trace.y = thinned(*residual, thin);
    for (double& y : trace.y) {
      y = -y;  // the file holds leaking minus healthy
      size = std::max(size, std::abs(y));
    }
    plot.traces.push_back(std::move(trace));
  }
  const ReadableUnit unit = readable_unit(size, "m");
  for (Trace& trace : plot.traces)
    for (double& y : trace.y) y /= unit.si;
  plot.y_label = fmt::format("residual of the position [{}]", unit.name);
  return plot;
}

/// One column of a level's series over its period, times a factor; empty without that column.
Trace level_trace(const Table& table, const char* column, double factor) {
  Trace trace;
  const auto* values = table.find(column);
  const auto* time_s = table.find("time_s");
  if (values == nullptr || time_s == nullptr || values->empty()) return trace;
  const Buckets thin = buckets(values->size(), kLevelPoints);
  trace.x = thinned_times(*time_s, thin);
  trace.y = thinned(*values, thin);
  for (double& y : trace.y) y *= factor;
  return trace;
}

/// What the cylinder does of its reference at each level; the source paper's figures 8 and 10.
Plot positions_plot(const std::vector<std::pair<std::string, Table>>& levels) {
  Plot plot;
  plot.title = "Position in percent of the amplitude of the reference, over one period";
  plot.x_label = "time [s]";
  plot.y_label = "position [% of the amplitude]";
  for (const auto& [level, table] : levels) {
    const auto* drive = table.find("drive");
    if (drive == nullptr || drive->empty()) continue;
    const double amplitude = *std::max_element(drive->begin(), drive->end());
    if (!(amplitude > 0.0)) continue;
    Trace trace = level_trace(table, "position_m", 100.0 / amplitude);
    if (trace.x.empty()) continue;
    trace.name = level;
    trace.style = kLevelStyles[std::min(plot.traces.size(), kLevelStyles.size() - 1)];
    plot.traces.push_back(std::move(trace));
  }
  return plot;
}

/// The flows at one level; the source paper's figures 9 and 11.
Plot flows_plot(const std::string& level, const Table& table) {
  struct Column {
    const char* name;
    const char* column;
    const char* style;
  };
  constexpr std::array kColumns{Column{"servo", "servo_flow_m3_per_s", "servo"},
                                Column{"work", "work_flow_m3_per_s", "model"},
                                Column{"leakage", "leakage_flow_m3_per_s", "leak"}};
  constexpr double kLitresPerMinuteEach = 60e3;  ///< per m3/s
  Plot plot;
  plot.title = fmt::format("Servo, work and leakage flow at the level {}, over one period", level);
  plot.x_label = "time [s]";
  plot.y_label = "flow [L/min]";
  for (const Column& each : kColumns) {
    Trace trace = level_trace(table, each.column, kLitresPerMinuteEach);
    if (trace.x.empty()) continue;
    trace.name = each.name;
    trace.style = each.style;
    plot.traces.push_back(std::move(trace));
  }
  return plot;
}

/// "Critical: 30.6 % of the servo flow leak, at the coefficient 0.6"
std::string level_caption(const Json& features, const std::string& level) {
  for (const Json& feature : features) {
    if (text_of(feature, "level") != level) continue;
    const auto servo = number_of(feature, "servo_flow_l_per_min");
    const auto leak = number_of(feature, "leak_flow_l_per_min");
    if (!servo || !leak || !(*servo > 0.0)) break;
    return fmt::format("{}: {:.3g} % of the servo flow leak, at the coefficient {:g}", level,
                       100.0 * *leak / *servo, number_of(feature, "coefficient").value_or(0.0));
  }
  return level;
}

std::string leak_sentence(const Json& table) {
  const Json& summary = table.at("summary");
  const int published = summary.at("published").get<int>();
  if (published == 0) {
    return fmt::format("{} leakage coefficients; nothing was published to compare them with.",
                       table.at("entries").size());
  }
  return fmt::format("{} of {} published coefficients are met within 10 %, {} within 16 %.",
                     summary.at("within_10_percent").get<int>(), published,
                     summary.at("within_16_percent").get<int>());
}

}  // namespace

Json leak_table_headline(const Json& table) {
  Json view = make_headline("LEAK TABLE", "○", "none", leak_sentence(table));
  for (const Json& entry : table.at("entries")) {
    if (text_of(entry, "grade") != "outlier") continue;
    add_reason(
        view,
        fmt::format("{} at {:g} %: {}", drive_name(entry),
                    number_of(entry, "target_percent").value_or(0.0), text_of(entry, "note")),
        "leak-table");
  }
  return view;
}

std::vector<Figure> leak_table_figures(const LeakTableFiles& stored) {
  std::vector<Figure> figures;
  if (stored.table.at("summary").at("published").get<int>() > 0)
    figures.push_back({"leak_table", agreement_plot(stored.table.at("entries"))});
  if (stored.levels.empty()) return figures;
  figures.push_back({"leak_levels", levels_plot(stored.levels)});
  figures.push_back({"leak_positions", positions_plot(stored.levels)});
  for (const auto& [level, table] : stored.levels)
    figures.push_back({"leak_flows_" + plain_name(level), flows_plot(level, table)});
  return figures;
}

Json leak_table_view(const LeakTableFiles& stored) {
  const Json& table = stored.table;
  const Json& entries = table.at("entries");
  const std::vector<double> targets = targets_of(entries);
  const bool published = table.at("summary").at("published").get<int>() > 0;
  Json view;
  view["sentence"] = leak_sentence(table);
  view["share"] = text_of(table, "share");
  view["targets"] = Json::array();
  for (const double target : targets) view["targets"].push_back(fmt::format("{:g} %", target));
  view["rows"] = leak_rows(entries, targets);
  view["has_published"] = published;
  if (published) {
    view["share_rms"] = shown_in(table.at("summary").at("share_rms_percent"), 1.0, 3);
    view["plot_html"] = svg(agreement_plot(entries));
  }
  view["notes"] = Json::array();
  for (const Json& entry : entries) {
    if (text_of(entry, "note").empty()) continue;
    view["notes"].push_back(fmt::format("{} at {:g} %: {}", drive_name(entry),
                                        number_of(entry, "target_percent").value_or(0.0),
                                        text_of(entry, "note")));
  }
  view["has_notes"] = !view["notes"].empty();
  const auto texts = [&](const char* key) {
    return table.contains(key) && table.at(key).is_array() ? table.at(key) : Json::array();
  };
  view["of_fit"] = texts("notes");
  view["has_of_fit"] = !view["of_fit"].empty();
  view["warnings"] = texts("warnings");
  view["has_warnings"] = !view["warnings"].empty();
  view["normals"] = Json::array();
  for (const Json& normal : table.at("normal")) {
    view["normals"].push_back(
        {{"signal", drive_name(normal)},
         {"coefficient", shown_in(normal.at("published_coefficient"), 1.0, 4)},
         {"share", shown_in(normal.at("share_at_published_percent"), 1.0, 3)}});
  }
  view["has_normals"] = !view["normals"].empty();
  view["features"] = feature_rows(table.at("features"));
  view["has_features"] = !view["features"].empty();
  view["residual"] = text_of(table, "residual");
  view["has_levels"] = !stored.levels.empty();
  if (!stored.levels.empty()) {
    view["levels_html"] = svg(levels_plot(stored.levels));
    view["positions_html"] = svg(positions_plot(stored.levels));
  }
  view["flows"] = Json::array();
  for (const auto& [level, series] : stored.levels) {
    view["flows"].push_back({{"caption", level_caption(table.at("features"), level)},
                             {"plot_html", svg(flows_plot(level, series))}});
  }
  view["assumptions"] = Json::array();
  for (const Json& each : table.at("assumptions")) {
    view["assumptions"].push_back({{"name", text_of(each, "key")},
                                   {"value", shown(each.at("value"), text_of(each, "unit"), 5)},
                                   {"source", text_of(each, "source")}});
  }
  view["combinations"] = Json::array();
  for (const Json& each : table.at("fixed_combinations")) {
    view["combinations"].push_back({{"formula", text_of(each, "formula")},
                                    {"value", shown_in(each.at("value"), 1.0, 5)},
                                    {"unit", text_of(each, "unit")}});
  }
  view["has_combinations"] = !view["combinations"].empty();
  return view;
}

}  // namespace rigcal::report
