#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/leak/leak_table.hpp"
#include "report/text/readable.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using datasets::Feature;
using Align = TextTable::Align;

std::string heading(const std::string& text, const Style& style) {
  return style.colour ? fmt::format("\x1b[1m{}\x1b[0m\n", text) : text + "\n";
}

std::string signal_text(const datasets::LeakSignal& signal) {
  return fmt::format("{} {:g} Hz", to_string(signal.waveform), signal.frequency_hz);
}

/// Three significant digits, without an exponent for usual coefficients.
std::string coefficient_text(double value) {
  if (!(value >= 1e-4 && value < 1e4)) return fmt::format("{:.3g}", value);
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(value))));
  return fmt::format("{:.{}f}", value, decimals);
}

/// "±0.21 %" of the coefficient; where that is wide the two ends: "[0.2, 0.35]".
std::string interval_text(double value, double low, double high) {
  constexpr double kWide = 0.1;
  const double half = 0.5 * (high - low) / value;
  return half < kWide ? fmt::format("±{:.2g} %", 100.0 * half)
                      : fmt::format("[{}, {}]", coefficient_text(low), coefficient_text(high));
}

std::string roots_text(const calib::LeakEntry& entry) {
  if (entry.roots.empty()) return "-";
  std::string text;
  for (const calib::LeakRoot& root : entry.roots) {
    if (!text.empty()) text += ", ";
    text += (root.determined() ? "" : "~") + coefficient_text(root.coefficient);
    if (const auto range = root.ci95())
      text += " " + interval_text(root.coefficient, range->front(), range->back());
  }
  return text;
}

/// "0.250/0.25 +0 %" where something was published, "0.250" elsewhere.
std::string cell(const calib::LeakEntry& entry) {
  std::string text = roots_text(entry);
  if (!entry.comparison) return text;
  text += fmt::format("/{:g}", entry.comparison->published);
  if (entry.comparison->relative_error_percent) {
    text += fmt::format(" {:+.0f} %", *entry.comparison->relative_error_percent);
  }
  return text + (entry.grade == calib::LeakGrade::outlier ? " !" : "");
}

/// "10.0 (9.8-10.2)": share at the published coefficient, and the range that its rounding allows.
std::string share_cell(const calib::LeakEntry& entry) {
  if (!entry.comparison) return "-";
  const calib::LeakComparison& c = *entry.comparison;
  return fmt::format("{:.3g} ({:.3g}-{:.3g})", c.share_percent, c.share_low_percent,
                     c.share_high_percent);
}

template <typename Cell>
std::string grid(const LeakTableResult& result, Cell text_of, const Style& style) {
  std::vector<TextTable::Column> columns{{"share", Align::right}};
  for (const datasets::LeakSignal& signal : result.settings.signals) {
    columns.push_back({signal_text(signal), Align::right});
  }
  TextTable table(columns);
  const std::size_t targets = result.settings.targets_percent.size();
  for (std::size_t t = 0; t < targets; ++t) {
    std::vector<std::string> row{fmt::format("{:g} %", result.settings.targets_percent[t])};
    for (std::size_t s = 0; s < result.settings.signals.size(); ++s) {
      row.push_back(text_of(result.table.entries[s * targets + t]));
    }
    table.add(row);
  }
  return table.text(style.columns);
}

std::string notes_text(const LeakTableResult& result) {
  std::string text;
  for (const calib::LeakEntry& entry : result.table.entries) {
    if (entry.note.empty()) continue;
    text += fmt::format("  {}, {:g} %: {}\n", signal_text(entry.signal), entry.target_percent,
                        entry.note);
  }
  return text;
}

std::string normal_text(const LeakTableResult& result, const Style& style) {
  if (result.table.normals.empty()) return {};
  TextTable table({{"signal"}, {"C published", Align::right}, {"share at it", Align::right}});
  for (const calib::NormalEntry& normal : result.table.normals) {
    table.add({signal_text(normal.signal), fmt::format("{:g}", normal.coefficient),
               fmt::format("{:.3g} %", normal.share_percent)});
  }
  return "\n" + heading("Without a fault", style) + table.text(style.columns);
}

/// "2.0887/2.089 -0.1 %"
std::string against(double computed, const datasets::PrintedFeatures& printed, Feature feature,
                    double unit) {
  const auto found = printed.printed.find(feature);
  if (found == printed.printed.end()) return fmt::format("{:.4g}", computed / unit);
  const bool left_out = std::find(printed.left_out.begin(), printed.left_out.end(), feature) !=
                        printed.left_out.end();
  const double ratio = computed / found->second;
  const std::string error =
      ratio < 2.0 ? fmt::format("{:+.1f} %", 100.0 * (ratio - 1.0)) : fmt::format("x{:.1f}", ratio);
  return fmt::format("{:.4f}/{:.4f} {}{}", computed / unit, found->second / unit, error,
                     left_out ? " *" : "");
}

std::string features_text(const LeakTableResult& result, const Style& style) {
  if (result.table.features.empty()) return {};
  TextTable table({{"level"},
                   {"C", Align::right},
                   {"servo flow L/min", Align::right},
                   {"leak flow L/min", Align::right},
                   {"mean", Align::right},
                   {"rms", Align::right},
                   {"std", Align::right}});
  std::string notes;
  for (const calib::FeatureRow& row : result.table.features) {
    const datasets::PrintedFeatures& p = row.printed;
    table.add({p.level, fmt::format("{:g}", p.coefficient),
               against(row.servo_flow_m3_per_s, p, Feature::servo_flow, kLitrePerMinute),
               against(row.leak_flow_m3_per_s, p, Feature::leak_flow, kLitrePerMinute),
               against(row.features.mean, p, Feature::mean, 1.0),
               against(row.features.rms, p, Feature::rms, 1.0),
               against(row.features.std, p, Feature::std, 1.0)});
    if (!p.reason.empty()) notes += fmt::format("  * {}: {}\n", p.level, p.reason);
    for (const double c : row.coefficients_for_leak_flow) {
      notes += fmt::format("  {}: the published leak flow comes at C = {}\n", p.level,
                           coefficient_text(c));
    }
  }
  return "\n" +
         heading(fmt::format("Flows and features of the residual, {}: computed/published",
                             signal_text(*result.settings.feature_signal)),
                 style) +
         table.text(style.columns) + notes;
}

bool has_intervals(const calib::LeakTable& table) {
  return std::any_of(table.entries.begin(), table.entries.end(), [](const auto& entry) {
    return !entry.roots.empty() && entry.roots.front().log_error.has_value();
  });
}

std::string assumptions_text(const LeakTableResult& result, const Style& style) {
  std::string text;
  for (const std::string& note : result.notes) text += "\n" + note;
  if (!result.notes.empty()) text += "\n";
  if (!result.settings.assumptions.empty()) {
    TextTable table({{"assumption"}, {"value", Align::right}, {"source"}});
    for (const datasets::Assumption& assumption : result.settings.assumptions) {
      const model::ParameterSpec& spec =
          datasets::assumption_spec(result.campaign.rig.plant, assumption.index);
      table.add({std::string(spec.key), readable(assumption.value, spec.unit), assumption.source});
    }
    text += "\n" + heading("What it rests on", style) + table.text(style.columns);
  }
  if (!result.table.fixed_combinations.empty()) {
    TextTable table({{"combination"}, {"value", Align::right}, {"unit"}});
    for (const calib::FixedCombination& combination : result.table.fixed_combinations) {
      table.add({std::string(combination.formula), fmt::format("{:.4g}", combination.value),
                 std::string(combination.unit)});
    }
    text +=
        "\n" +
        heading("Combinations that the shares depend on, and not on the values in them", style) +
        table.text(style.columns);
  }
  return text;
}

}  // namespace

std::string leak_table_text(const LeakTableResult& result, const Style& style) {
  const calib::LeakSummary& summary = result.table.summary;
  const bool published = summary.published > 0;
  std::string text =
      heading(fmt::format("{}: leakage coefficient by share of the servo flow{}{}",
                          result.campaign.name,
                          has_intervals(result.table) ? " with its 95 % interval" : "",
                          published ? ", computed/published and error" : ""),
              style) +
      grid(result, cell, style) + notes_text(result);
  if (published) {
    text += "\n" +
            heading("Share in % at the published coefficient (and within its rounding)", style) +
            grid(result, share_cell, style);
  }
  text +=
      normal_text(result, style) + features_text(result, style) + assumptions_text(result, style);
  if (published) {
    text += fmt::format(
        "\n{} of {} published coefficients within 10 %, {} within 16 %; shares at them off by "
        "{:.1f} % rms\n",
        summary.within_10, summary.published, summary.within_16, *summary.share_rms_percent);
  }
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace rigcal::report
