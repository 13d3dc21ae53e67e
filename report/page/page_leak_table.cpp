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

/// "0.1 Hz sine, 50.8 mm" of an entry or of the rig without a fault.
template <typename Entry>
std::string drive_name(const Entry& entry) {
  std::string text = fmt::format("{:.6g} Hz {}", entry.frequency_hz, to_string(entry.waveform));
  if (entry.amplitude_m) text += ", " + readable(*entry.amplitude_m, "m", 4);
  if (entry.amplitude_v) text += ", " + readable(*entry.amplitude_v, "V", 4);
  return text;
}

Json grade_badge(calib::LeakGrade grade) {
  using calib::LeakGrade;
  const std::string word(to_string(grade));
  switch (grade) {
    case LeakGrade::within_10:
      return {{"word", word}, {"mark", "✓"}, {"class", "good"}};
    case LeakGrade::within_16:
      return {{"word", word}, {"mark", "!"}, {"class", "warn"}};
    case LeakGrade::outlier:
      return {{"word", word}, {"mark", "✕"}, {"class", "bad"}};
    case LeakGrade::not_published:
      break;
  }
  return {{"word", word}, {"mark", ""}, {"class", "none"}};
}

/// All roots of an entry; "~" before those that the share hardly determines.
std::string coefficients_text(const StoredLeakEntry& entry) {
  std::string text;
  for (const double root : entry.coefficients) {
    if (!std::isfinite(root)) continue;
    text += fmt::format("{}{}{:.3g}", text.empty() ? "" : ", ", entry.determined ? "" : "~", root);
  }
  return text.empty() ? "no coefficient" : text;
}

/// Their intervals; results without a fit, or of before there were any, have none.
std::string intervals_text(const StoredLeakEntry& entry) {
  std::string text;
  if (!entry.coefficients_ci95) return text;
  for (const auto& range : *entry.coefficients_ci95) {
    if (!range || !std::isfinite(range->low) || !std::isfinite(range->high)) continue;
    const double half = (range->high - range->low) / (range->high + range->low);
    text += text.empty() ? "" : ", ";
    text += half < kWideInterval ? fmt::format("±{:.2g} %", 100.0 * half)
                                 : fmt::format("{:.3g} … {:.3g}", range->low, range->high);
  }
  return text;
}

/// "+4.2 %"; a dash where there is no error.
std::string error_text(const std::optional<double>& percent) {
  return percent ? fmt::format("{:+.1f} %", *percent) : std::string("–");
}

Json leak_cell(const StoredLeakEntry& entry) {
  Json cell;
  cell["coefficients"] = coefficients_text(entry);
  cell["roots"] = Json::array();
  for (const double root : entry.coefficients)
    cell["roots"].push_back({{"exact", shown_in(root, 1.0).at("exact")}});
  cell["interval"] = intervals_text(entry);
  cell["has_interval"] = !cell["interval"].get_ref<const std::string&>().empty();
  cell["published"] = entry.published_coefficient.has_value();
  cell["badge"] = grade_badge(entry.grade);
  if (!entry.published_coefficient) return cell;
  cell["published_coefficient"] = shown_in(*entry.published_coefficient, 1.0, 6);
  cell["error"] = error_text(entry.relative_error_percent);
  cell["share"] = shown_in(entry.share_at_published_percent, 1.0, 3);
  const auto& range = entry.share_by_rounding_percent;
  cell["has_range"] = range.has_value();
  if (range) {
    cell["range_low"] = shown_in(range->low, 1.0, 3);
    cell["range_high"] = shown_in(range->high, 1.0, 3);
  }
  return cell;
}

/// Signals by target shares, in the order of the file.
Json leak_rows(const std::vector<StoredLeakEntry>& entries, const std::vector<double>& targets) {
  std::vector<std::string> names;
  for (const StoredLeakEntry& entry : entries) {
    const std::string name = drive_name(entry);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  Json rows = Json::array();
  for (const std::string& name : names) {
    Json cells = Json::array();
    for (const double target : targets) {
      Json cell{{"there", false}};
      for (const StoredLeakEntry& entry : entries) {
        if (drive_name(entry) != name || entry.target_percent != target) continue;
        cell = leak_cell(entry);
        cell["there"] = true;
      }
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"signal", name}, {"cells", std::move(cells)}});
  }
  return rows;
}

std::vector<double> targets_of(const std::vector<StoredLeakEntry>& entries) {
  std::vector<double> targets;
  for (const StoredLeakEntry& entry : entries) {
    if (std::find(targets.begin(), targets.end(), entry.target_percent) == targets.end())
      targets.push_back(entry.target_percent);
  }
  return targets;
}

/// Computed over published coefficients; what is met lies on the line.
Plot agreement_plot(const std::vector<StoredLeakEntry>& entries) {
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
  for (const StoredLeakEntry& entry : entries) {
    const auto& published = entry.published_coefficient;
    if (!published || *published <= 0.0) continue;
    Trace& into = entry.grade == calib::LeakGrade::outlier ? outliers : met;
    double nearest = std::nan("");
    for (const double value : entry.coefficients) {
      if (!std::isfinite(value)) continue;
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

Json against_published(double computed, const std::optional<double>& published) {
  Json cell{{"computed", shown_in(computed, 1.0, 4)}, {"published", published.has_value()}};
  if (!published) return cell;
  cell["published_value"] = shown_in(*published, 1.0, 4);
  const bool has_error = std::isfinite(computed) && *published != 0.0;
  cell["error"] =
      error_text(has_error ? std::optional(100.0 * (computed / *published - 1.0)) : std::nullopt);
  return cell;
}

Json feature_rows(const std::vector<StoredFeatures>& features) {
  Json rows = Json::array();
  for (const StoredFeatures& f : features) {
    rows.push_back(
        {{"level", f.level},
         {"coefficient", shown_in(f.coefficient, 1.0, 4)},
         {"cells",
          {against_published(f.servo_flow_l_per_min, f.published_servo_flow_l_per_min),
           against_published(f.leak_flow_l_per_min, f.published_leak_flow_l_per_min),
           against_published(f.mean, f.published_mean), against_published(f.rms, f.published_rms),
           against_published(f.std, f.published_std)}},
         {"reason", f.reason.value_or("")},
         {"has_reason", !f.reason.value_or("").empty()}});
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
    trace.x = thinned_times(*time_s, *residual, thin);
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
  trace.x = thinned_times(*time_s, *values, thin);
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
std::string level_caption(const std::vector<StoredFeatures>& features, const std::string& level) {
  for (const StoredFeatures& f : features) {
    if (f.level != level) continue;
    if (!(f.servo_flow_l_per_min > 0.0) || std::isnan(f.leak_flow_l_per_min)) break;
    return fmt::format("{}: {:.3g} % of the servo flow leak, at the coefficient {:g}", level,
                       100.0 * f.leak_flow_l_per_min / f.servo_flow_l_per_min, f.coefficient);
  }
  return level;
}

std::string leak_sentence(const StoredLeakTable& table) {
  const StoredLeakSummary& summary = table.summary;
  if (summary.published == 0) {
    return fmt::format("{} leakage coefficients; nothing was published to compare them with.",
                       table.entries.size());
  }
  return fmt::format("{} of {} published coefficients are met within 10 %, {} within 16 %.",
                     summary.within_10_percent, summary.published, summary.within_16_percent);
}

std::string noted(const StoredLeakEntry& entry) {
  return fmt::format("{} at {:g} %: {}", drive_name(entry), entry.target_percent, entry.note);
}

/// Texts of a list, and whether there are any, as `has_<key>`.
void put_texts(Json& view, const std::string& key, const std::vector<std::string>& texts) {
  view[key] = texts;
  view["has_" + key] = !texts.empty();
}

}  // namespace

Json leak_table_headline(const LeakTableFiles& stored) {
  const StoredLeakTable& table = stored.result;
  Json view = make_headline("LEAK TABLE", "○", "none", leak_sentence(table));
  for (const StoredLeakEntry& entry : table.entries) {
    if (entry.grade == calib::LeakGrade::outlier) add_reason(view, noted(entry), "leak-table");
  }
  return view;
}

std::vector<Figure> leak_table_figures(const LeakTableFiles& stored) {
  std::vector<Figure> figures;
  if (stored.result.summary.published > 0)
    figures.push_back({"leak_table", agreement_plot(stored.result.entries)});
  if (stored.levels.empty()) return figures;
  figures.push_back({"leak_levels", levels_plot(stored.levels)});
  figures.push_back({"leak_positions", positions_plot(stored.levels)});
  for (const auto& [level, table] : stored.levels)
    figures.push_back({"leak_flows_" + plain_name(level), flows_plot(level, table)});
  return figures;
}

Json leak_table_view(const LeakTableFiles& stored) {
  const StoredLeakTable& table = stored.result;
  const std::vector<double> targets = targets_of(table.entries);
  const bool published = table.summary.published > 0;
  Json view;
  view["sentence"] = leak_sentence(table);
  view["share"] = table.share;
  view["targets"] = Json::array();
  for (const double target : targets) view["targets"].push_back(fmt::format("{:g} %", target));
  view["rows"] = leak_rows(table.entries, targets);
  view["has_published"] = published;
  if (published) {
    view["share_rms"] = shown_in(table.summary.share_rms_percent, 1.0, 3);
    view["plot_html"] = svg(agreement_plot(table.entries));
  }
  std::vector<std::string> notes;
  for (const StoredLeakEntry& entry : table.entries) {
    if (!entry.note.empty()) notes.push_back(noted(entry));
  }
  put_texts(view, "notes", notes);
  put_texts(view, "of_fit", table.notes.value_or(std::vector<std::string>()));
  put_texts(view, "warnings", table.warnings.value_or(std::vector<std::string>()));
  view["normals"] = Json::array();
  for (const StoredNormal& normal : table.normal) {
    view["normals"].push_back({{"signal", drive_name(normal)},
                               {"coefficient", shown_in(normal.published_coefficient, 1.0, 4)},
                               {"share", shown_in(normal.share_at_published_percent, 1.0, 3)}});
  }
  view["has_normals"] = !table.normal.empty();
  view["features"] = feature_rows(table.features);
  view["has_features"] = !table.features.empty();
  view["residual"] = table.residual;
  view["has_levels"] = !stored.levels.empty();
  if (!stored.levels.empty()) {
    view["levels_html"] = svg(levels_plot(stored.levels));
    view["positions_html"] = svg(positions_plot(stored.levels));
  }
  view["flows"] = Json::array();
  for (const auto& [level, series] : stored.levels) {
    view["flows"].push_back({{"caption", level_caption(table.features, level)},
                             {"plot_html", svg(flows_plot(level, series))}});
  }
  view["assumptions"] = Json::array();
  for (const StoredAssumption& each : table.assumptions) {
    view["assumptions"].push_back(
        {{"name", each.key}, {"value", shown(each.value, each.unit, 5)}, {"source", each.source}});
  }
  view["combinations"] = Json::array();
  for (const StoredCombination& each : table.fixed_combinations) {
    view["combinations"].push_back(
        {{"formula", each.formula}, {"value", shown_in(each.value, 1.0, 5)}, {"unit", each.unit}});
  }
  view["has_combinations"] = !table.fixed_combinations.empty();
  return view;
}

}  // namespace rigcal::report
