#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/quantity.hpp"
#include "report/document/words.hpp"
#include "report/figure/decimate.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

constexpr std::size_t kLevelPoints = 1200;
/// If half the interval exceeds this fraction of its centre, both ends are shown.
constexpr double kWideInterval = 0.1;
/// Style classes for levels drawn side by side; even without colour their order distinguishes them.
constexpr std::array kLevelStyles{"model", "residual", "servo", "leak", "reference"};

/// Names the drive of an entry or of the fault-free rig: "sine 0.1 Hz, 50.8 mm".
std::string drive_name(const diagnosis::LeakDrive& drive) {
  std::string text = fmt::format("{} {:.6g} Hz", to_string(drive.waveform), drive.frequency_hz);
  if (drive.amplitude_m) text += ", " + readable(*drive.amplitude_m, "m", 4);
  if (drive.amplitude_v) text += ", " + readable(*drive.amplitude_v, "V", 4);
  return text;
}

/// Lists all roots of an entry, with "~" before roots that the share barely determines.
Line coefficients_line(const diagnosis::LeakEntry& entry) {
  Line line;
  for (const double root : entry.coefficients) {
    if (!std::isfinite(root)) continue;
    if (!line.empty()) line.emplace_back(", ");
    if (!entry.determined) line.emplace_back("~");
    line.emplace_back(doc::Quantity{root, fmt::format("{:.3g}", root)});
  }
  if (line.empty()) line.emplace_back("no coefficient");
  return line;
}

/// Formats the intervals of the roots; empty for results without a fit and for results from before
/// intervals were introduced.
std::string intervals_text(const diagnosis::LeakEntry& entry) {
  std::string text;
  for (const auto& range : entry.coefficients_ci95) {
    if (!range || !std::isfinite(range->low) || !std::isfinite(range->high)) continue;
    const double half = (range->high - range->low) / (range->high + range->low);
    text += text.empty() ? "" : ", ";
    text += half < kWideInterval ? fmt::format("± {:.2g} %", 100.0 * half)
                                 : fmt::format("{:.3g} … {:.3g}", range->low, range->high);
  }
  return text;
}

/// Formats an error: "+4.2 %", or a dash if there is none.
std::string error_text(const std::optional<double>& percent) {
  return percent ? fmt::format("{:+.1f} %", *percent) : std::string("–");
}

doc::Tile leak_tile(const diagnosis::LeakEntry& entry) {
  doc::Tile tile{doc::badge(entry.grade), coefficients_line(entry)};
  const std::string interval = intervals_text(entry);
  if (!interval.empty()) tile.below.push_back({interval});
  if (entry.published_coefficient)
    tile.below.push_back({"published ", doc::in_unit(*entry.published_coefficient, 1.0, 6),
                          " · " + error_text(entry.relative_error_percent)});
  return tile;
}

/// Returns a cell with the share at the published coefficient and the range that its rounding
/// allows.
doc::Cell published_share_cell(const diagnosis::LeakEntry& entry) {
  if (!entry.published_coefficient) return doc::Cell("–");
  doc::Cell cell{Line{doc::in_unit(entry.share_at_published_percent, 1.0, 3)}};
  if (const auto& range = entry.share_by_rounding_percent)
    cell.below = {
        {"(", doc::in_unit(range->low, 1.0, 3), " – ", doc::in_unit(range->high, 1.0, 3), ")"}};
  return cell;
}

/// Adds a row for each signal and a column for each target share, in the order of the file.
///
/// @param cell_of  makes the cell of an entry
template <typename CellOf>
void add_leak_rows(const std::vector<diagnosis::LeakEntry>& entries,
                   const std::vector<double>& targets, CellOf cell_of, doc::Table& table) {
  std::vector<std::string> names;
  for (const diagnosis::LeakEntry& entry : entries) {
    const std::string name = drive_name(entry.drive);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  for (const std::string& name : names) {
    doc::Row row{{name}};
    for (const double target : targets) {
      doc::Cell& cell = row.cells.emplace_back();
      for (const diagnosis::LeakEntry& entry : entries) {
        if (drive_name(entry.drive) == name && entry.target_percent == target)
          cell = cell_of(entry);
      }
    }
    table.rows.push_back(std::move(row));
  }
}

std::vector<double> targets_of(const std::vector<diagnosis::LeakEntry>& entries) {
  std::vector<double> targets;
  for (const diagnosis::LeakEntry& entry : entries) {
    if (std::find(targets.begin(), targets.end(), entry.target_percent) == targets.end())
      targets.push_back(entry.target_percent);
  }
  return targets;
}

/// Plots computed over published coefficients. With perfect agreement all points would be on the
/// line.
Plot agreement_plot(const std::vector<diagnosis::LeakEntry>& entries) {
  Plot plot{"Computed over published leakage coefficients", "published coefficient",
            "computed coefficient", 460.0, 320.0};
  plot.log_x = plot.log_y = true;
  double low = HUGE_VAL;
  double high = 0.0;
  Trace met = empty_trace(Trace::Kind::points, "model", "within 16 %");
  Trace outliers = empty_trace(Trace::Kind::points, "residual", "outlier");
  for (const diagnosis::LeakEntry& entry : entries) {
    const auto& published = entry.published_coefficient;
    if (!published || *published <= 0.0) continue;
    Trace& into = entry.grade == diagnosis::LeakGrade::outlier ? outliers : met;
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

doc::Cell against_published(double computed, const std::optional<double>& published) {
  doc::Cell cell{Line{doc::in_unit(computed, 1.0, 4)}};
  if (!published) return cell;
  const bool has_error = std::isfinite(computed) && *published != 0.0;
  cell.below = {{"published ", doc::in_unit(*published, 1.0, 4),
                 " · " + error_text(has_error ? std::optional(100.0 * (computed / *published - 1.0))
                                              : std::nullopt)}};
  return cell;
}

doc::Table feature_table(const std::vector<diagnosis::FeatureRow>& features) {
  doc::Table table{"Flows and features by level"};
  table.columns = {{"Level"},
                   {"Coefficient", Kind::number},
                   {"Servo flow, L/min", Kind::number},
                   {"Leak flow, L/min", Kind::number},
                   {"Mean", Kind::number},
                   {"RMS", Kind::number},
                   {"Std", Kind::number}};
  for (const diagnosis::FeatureRow& f : features) {
    doc::Row row{{f.level, doc::in_unit(f.coefficient, 1.0, 4),
                  against_published(f.servo_flow_l_per_min, f.published_servo_flow_l_per_min),
                  against_published(f.leak_flow_l_per_min, f.published_leak_flow_l_per_min),
                  against_published(f.mean, f.published_mean),
                  against_published(f.rms, f.published_rms),
                  against_published(f.std, f.published_std)}};
    if (f.reason && !f.reason->empty()) row.notes = {*f.reason};
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot levels_plot(const std::vector<std::pair<std::string, Table>>& levels) {
  Plot plot{"Position without the leak minus position with it, over one period", "time [s]"};
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
      y = -y;  // the file contains leaking minus healthy
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

/// Returns one column of a level's series over its period, multiplied by a factor; empty if the
/// column does not exist.
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

/// Plots the response of the cylinder to its reference at each level, as in figures 8 and 10 of the
/// source paper.
Plot positions_plot(const std::vector<std::pair<std::string, Table>>& levels) {
  Plot plot{"Position in percent of the amplitude of the reference, over one period", "time [s]",
            "position [% of the amplitude]"};
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

/// Plots the flows at one level, as in figures 9 and 11 of the source paper.
Plot flows_plot(const std::string& level, const Table& table) {
  struct Column {
    const char* name;
    const char* column;
    const char* style;
  };
  constexpr std::array kColumns{Column{"servo", "servo_flow_m3_per_s", "servo"},
                                Column{"work", "work_flow_m3_per_s", "model"},
                                Column{"leakage", "leakage_flow_m3_per_s", "leak"}};
  Plot plot{fmt::format("Servo, work and leakage flow at the level {}, over one period", level),
            "time [s]", "flow [L/min]"};
  for (const Column& each : kColumns) {
    Trace trace = level_trace(table, each.column, kLitresPerMinute);
    if (trace.x.empty()) continue;
    trace.name = each.name;
    trace.style = each.style;
    plot.traces.push_back(std::move(trace));
  }
  return plot;
}

/// Returns, for example, "Critical: 30.6 % of the servo flow leak, at the coefficient 0.6".
std::string level_caption(const std::vector<diagnosis::FeatureRow>& features,
                          const std::string& level) {
  for (const diagnosis::FeatureRow& f : features) {
    if (f.level != level) continue;
    if (!(f.servo_flow_l_per_min > 0.0) || std::isnan(f.leak_flow_l_per_min)) break;
    return fmt::format("{}: {:.3g} % of the servo flow leaks at the coefficient {:g}", level,
                       100.0 * f.leak_flow_l_per_min / f.servo_flow_l_per_min, f.coefficient);
  }
  return level;
}

std::string leak_sentence(const StoredLeakTable& table) {
  const diagnosis::LeakSummary& summary = table.summary;
  if (summary.published == 0) {
    return fmt::format("{} leakage coefficients; nothing was published to compare them with.",
                       table.entries.size());
  }
  return fmt::format("{} of {} published coefficients are met within 10 %, {} within 16 %.",
                     summary.within_10_percent, summary.published, summary.within_16_percent);
}

std::string noted(const diagnosis::LeakEntry& entry) {
  return fmt::format("{} at {:g} %: {}", drive_name(entry.drive), entry.target_percent, entry.note);
}

/// Compares the published coefficients with the computed ones.
void add_published(const StoredLeakTable& table, const std::vector<double>& targets,
                   doc::Blocks& blocks) {
  if (table.summary.published == 0) return;
  blocks.emplace_back(doc::reading("✓ within 10 %, ! within 16 %, ✕ further off."));
  doc::Figure figure = figure_of(agreement_plot(table.entries));
  figure.narrow = true;
  blocks.emplace_back(std::move(figure));
  doc::Table shares{"Shares at the published coefficients"};
  shares.caption = {
      "Share in percent at the published coefficient, with the range due to its rounding; "
      "deviation from the target ",
      doc::in_unit(table.summary.share_rms_percent, 1.0, 3), " % rms"};
  shares.columns = {{"Signal"}};
  for (const double target : targets)
    shares.columns.push_back({fmt::format("{:g} %", target), Kind::number});
  add_leak_rows(table.entries, targets, published_share_cell, shares);
  blocks.emplace_back(std::move(shares));
}

void add_features(const LeakTableFiles& stored, doc::Blocks& blocks) {
  const StoredLeakTable& table = stored.result;
  if (table.features.empty()) return;
  blocks.emplace_back(doc::Heading{{"Flows and features of the residual"}});
  blocks.emplace_back(doc::reading("Residual: " + table.residual + "."));
  if (!stored.levels.empty()) {
    blocks.emplace_back(figure_of(levels_plot(stored.levels)));
    blocks.emplace_back(doc::reading("Position and flows at each leak level"));
    blocks.emplace_back(figure_of(positions_plot(stored.levels)));
    doc::Fold flows{"Servo, work and leakage flow at each level", {}};
    for (const auto& [level, series] : stored.levels)
      flows.blocks.emplace_back(
          figure_of(flows_plot(level, series), level_caption(table.features, level)));
    blocks.emplace_back(std::move(flows));
  }
  blocks.emplace_back(feature_table(table.features));
}

void add_normals(const std::vector<diagnosis::NormalEntry>& normals, doc::Blocks& blocks) {
  if (normals.empty()) return;
  doc::Table table{"Without a fault"};
  table.caption = {table.label};
  table.columns = {
      {"Signal"}, {"Published coefficient", Kind::number}, {"Share at it, %", Kind::number}};
  for (const diagnosis::NormalEntry& normal : normals)
    table.rows.push_back(
        {{drive_name(normal.drive), doc::in_unit(normal.published_coefficient, 1.0, 4),
          doc::in_unit(normal.share_at_published_percent, 1.0, 3)}});
  blocks.emplace_back(std::move(table));
}

doc::Fold assumptions_fold(const StoredLeakTable& table) {
  doc::Table values{"Values in use"};
  values.columns = {{"Parameter"}, {"Value", Kind::number}, {"Source", Kind::words}};
  for (const diagnosis::UsedValue& each : table.assumptions)
    values.rows.push_back({{each.key, doc::readable(each.value, each.unit, 5), each.source}});
  doc::Fold fold{"Basis of the table", {std::move(values)}};
  if (table.fixed_combinations.empty()) return fold;
  doc::Table combinations{"Fixed combinations"};
  combinations.caption = {"Combinations of values on which the shares depend"};
  combinations.columns = {{"Combination"}, {"Value", Kind::number}, {"Unit"}};
  for (const diagnosis::FixedCombination& each : table.fixed_combinations)
    combinations.rows.push_back(
        {{each.formula, doc::in_unit(each.value, 1.0, 5), typographic(each.unit)}});
  fold.blocks.emplace_back(std::move(combinations));
  return fold;
}

}  // namespace

doc::Verdict leak_table_headline(const LeakTableFiles& stored) {
  const StoredLeakTable& table = stored.result;
  doc::Verdict verdict{{doc::State::none, "LEAK TABLE"}, {leak_sentence(table)}};
  for (const diagnosis::LeakEntry& entry : table.entries) {
    if (entry.grade == diagnosis::LeakGrade::outlier)
      add_reason(verdict, noted(entry), "leak-table");
  }
  return verdict;
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

std::vector<doc::Section> leak_table_sections(const LeakTableFiles& stored) {
  const StoredLeakTable& table = stored.result;
  const std::vector<double> targets = targets_of(table.entries);
  const auto fit_notes = table.notes.value_or(std::vector<std::string>());
  doc::Section section{"leak-table", "Leak table"};
  doc::Blocks& blocks = section.blocks;
  blocks.emplace_back(doc::reading(fmt::format(
      "The leakage coefficient at which a share of the servo flow leaks ({}).{} A tilde: the "
      "share hardly determines the coefficient.{}",
      table.share,
      table.summary.published > 0
          ? " Below it the published one and how far the computed one deviates."
          : "",
      fit_notes.empty() ? "" : " Small: 95 % interval from the covariance of the fit.")));
  blocks.emplace_back(
      list_of(table.warnings.value_or(std::vector<std::string>()), doc::State::warn));
  for (const std::string& note : fit_notes)
    blocks.emplace_back(doc::reading(capitalised(note) + "."));
  doc::Table coefficients{"Leakage coefficients"};
  coefficients.caption = {"Leakage coefficient by signal and share of the servo flow"};
  coefficients.shape = doc::Table::Shape::matrix;
  coefficients.style = "leaks";
  coefficients.columns = {{"Signal"}};
  for (const double target : targets)
    coefficients.columns.push_back({fmt::format("{:g} %", target)});
  add_leak_rows(
      table.entries, targets,
      [](const diagnosis::LeakEntry& entry) {
        doc::Cell cell;
        cell.tiles = {leak_tile(entry)};
        return cell;
      },
      coefficients);
  blocks.emplace_back(std::move(coefficients));
  add_published(table, targets, blocks);
  std::vector<std::string> notes;
  for (const diagnosis::LeakEntry& entry : table.entries)
    if (!entry.note.empty()) notes.push_back(noted(entry));
  blocks.emplace_back(list_of(notes, doc::State::warn));
  add_normals(table.normal, blocks);
  add_features(stored, blocks);
  blocks.emplace_back(assumptions_fold(table));
  return {std::move(section)};
}

}  // namespace rigcal::report
