#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "report/leak/leak_table.hpp"
#include "report/store/csv_fields.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {
namespace {

std::string list(const std::vector<double>& values) {
  return fmt::format("{}", fmt::join(values, " "));
}

/// Lists the lower (or upper) ends of the intervals of all roots; empty without a fit.
std::string ends(const std::vector<std::optional<Range>>& ranges, double Range::*end) {
  std::vector<std::string> texts;
  for (const auto& range : ranges)
    if (range) texts.push_back(csv_number((*range).*end));
  return fmt::format("{}", fmt::join(texts, " "));
}

}  // namespace

std::string leak_table_csv(const LeakTableResult& result) {
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  std::string text =
      csv_row({"waveform", "frequency_hz", closed_loop ? "amplitude_m" : "amplitude_v",
               "target_percent", "coefficients", "ci95_low", "ci95_high", "log_slopes",
               "published_coefficient", "relative_error_percent", "share_at_published_percent",
               "share_by_rounding_low_percent", "share_by_rounding_high_percent", "grade", "note"});
  for (const calib::LeakEntry& entry : result.table.entries) {
    const auto& rounded = entry.share_by_rounding_percent;
    text +=
        csv_row({std::string(to_string(entry.drive.waveform)), csv_number(entry.drive.frequency_hz),
                 csv_number(entry.drive.amplitude()), csv_number(entry.target_percent),
                 list(entry.coefficients), ends(entry.coefficients_ci95, &Range::low),
                 ends(entry.coefficients_ci95, &Range::high), list(entry.log_slopes),
                 csv_number(entry.published_coefficient), csv_number(entry.relative_error_percent),
                 csv_number(entry.share_at_published_percent),
                 rounded ? csv_number(rounded->low) : std::string(),
                 rounded ? csv_number(rounded->high) : std::string(),
                 std::string(to_string(entry.grade)), csv_text(entry.note)});
  }
  return text;
}

std::string features_csv(const LeakTableResult& result) {
  std::string text =
      csv_row({"level", "coefficient", "servo_flow_l_per_min", "published_servo_flow_l_per_min",
               "leak_flow_l_per_min", "published_leak_flow_l_per_min", "mean", "published_mean",
               "rms", "published_rms", "std", "published_std"});
  for (const calib::FeatureRow& each : result.table.features) {
    text += csv_row(
        {csv_text(each.level), csv_number(each.coefficient), csv_number(each.servo_flow_l_per_min),
         csv_number(each.published_servo_flow_l_per_min), csv_number(each.leak_flow_l_per_min),
         csv_number(each.published_leak_flow_l_per_min), csv_number(each.mean),
         csv_number(each.published_mean), csv_number(each.rms), csv_number(each.published_rms),
         csv_number(each.std), csv_number(each.published_std)});
  }
  return text;
}

std::string level_csv(const datasets::LeakSignal& signal, const calib::PeriodicSeries& series,
                      const calib::PeriodicSeries* healthy) {
  const model::Signal drive =
      datasets::periodic_signal(signal.waveform, signal.amplitude, signal.frequency_hz);
  const std::size_t rows = series.time_s.size();
  const auto output = [](const calib::PeriodicSeries& of, std::size_t i, Eigen::Index k) {
    return of.run.outputs(static_cast<Eigen::Index>(i), k);
  };
  Table table;
  table.add("time_s", series.time_s);
  table.add("drive", rows, [&](std::size_t i) { return drive.value(series.time_s[i]); });
  for (Eigen::Index k = 0; k < series.run.outputs.cols(); ++k)
    table.add(std::string(output_name(calib::kFeatureOutputs[static_cast<std::size_t>(k)])), rows,
              [&](std::size_t i) { return output(series, i, k); });
  if (healthy != nullptr)
    table.add("residual_m", rows,
              [&](std::size_t i) { return output(series, i, 0) - output(*healthy, i, 0); });
  return csv_of(table);
}

}  // namespace rigcal::report
