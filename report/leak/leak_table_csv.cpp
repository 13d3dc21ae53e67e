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

using datasets::Feature;

template <typename Value>
std::string list(const std::vector<calib::LeakRoot>& roots, Value value) {
  std::vector<std::string> texts;
  for (const calib::LeakRoot& root : roots) texts.push_back(fmt::format("{}", root.*value));
  return fmt::format("{}", fmt::join(texts, " "));
}

/// Lists the lower (or upper) ends of the intervals of all roots; empty without a fit.
std::string ends(const std::vector<calib::LeakRoot>& roots, std::size_t end) {
  std::vector<std::string> texts;
  for (const calib::LeakRoot& root : roots) {
    if (const auto range = root.ci95()) texts.push_back(csv_number(range->at(end)));
  }
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
    const auto& c = entry.comparison;
    const auto of = [&](auto member) { return c ? csv_number((*c).*member) : std::string(); };
    text += csv_row(
        {std::string(to_string(entry.signal.waveform)), csv_number(entry.signal.frequency_hz),
         csv_number(entry.signal.amplitude), csv_number(entry.target_percent),
         list(entry.roots, &calib::LeakRoot::coefficient), ends(entry.roots, 0),
         ends(entry.roots, 1), list(entry.roots, &calib::LeakRoot::log_slope),
         of(&calib::LeakComparison::published), of(&calib::LeakComparison::relative_error_percent),
         of(&calib::LeakComparison::share_percent), of(&calib::LeakComparison::share_low_percent),
         of(&calib::LeakComparison::share_high_percent), std::string(to_string(entry.grade)),
         csv_text(entry.note)});
  }
  return text;
}

std::string features_csv(const LeakTableResult& result) {
  std::string text =
      csv_row({"level", "coefficient", "servo_flow_l_per_min", "published_servo_flow_l_per_min",
               "leak_flow_l_per_min", "published_leak_flow_l_per_min", "mean", "published_mean",
               "rms", "published_rms", "std", "published_std"});
  for (const calib::FeatureRow& each : result.table.features) {
    const auto printed = [&](Feature feature, double unit) -> std::optional<double> {
      const auto found = each.printed.printed.find(feature);
      if (found == each.printed.printed.end()) return std::nullopt;
      return found->second / unit;
    };
    text += csv_row({csv_text(each.printed.level), csv_number(each.printed.coefficient),
                     csv_number(each.servo_flow_m3_per_s / kLitrePerMinute),
                     csv_number(printed(Feature::servo_flow, kLitrePerMinute)),
                     csv_number(each.leak_flow_m3_per_s / kLitrePerMinute),
                     csv_number(printed(Feature::leak_flow, kLitrePerMinute)),
                     csv_number(each.features.mean), csv_number(printed(Feature::mean, 1.0)),
                     csv_number(each.features.rms), csv_number(printed(Feature::rms, 1.0)),
                     csv_number(each.features.std), csv_number(printed(Feature::std, 1.0))});
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
