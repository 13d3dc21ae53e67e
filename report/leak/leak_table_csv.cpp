#include <optional>

#include "report/leak/leak_table.hpp"
#include "report/store/csv_columns.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {
namespace {

using calib::FeatureRow;
using calib::LeakEntry;
using calib::LeakRoot;
using datasets::Feature;

/// Makes a getter that lists a value of each root that has it.
template <typename Get>
auto of_roots(Get get) {
  return [get](const LeakEntry& entry) {
    std::vector<double> values;
    for (const LeakRoot& root : entry.roots)
      if (const std::optional<double> value = std::invoke(get, root)) values.push_back(*value);
    return values;
  };
}

/// Makes a getter that lists the lower (0) or upper (1) ends of the intervals of the roots.
auto ends(std::size_t end) {
  return of_roots([end](const LeakRoot& root) {
    const auto range = root.ci95();
    return range ? std::optional(range->at(end)) : std::nullopt;
  });
}

/// Makes a getter of a published value, which is divided by `unit`.
auto printed(Feature feature, double unit = 1.0) {
  return [feature, unit](const FeatureRow& row) -> std::optional<double> {
    const auto found = row.printed.printed.find(feature);
    if (found == row.printed.printed.end()) return std::nullopt;
    return found->second / unit;
  };
}

double in_litres_per_minute(double flow_m3_per_s) { return flow_m3_per_s / kLitrePerMinute; }

}  // namespace

std::string leak_table_csv(const LeakTableResult& result) {
  using R = LeakEntry;
  using calib::LeakComparison;
  using datasets::LeakSignal;
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  return CsvColumns<R>()
      .add("waveform", &R::signal, &LeakSignal::waveform)
      .add("frequency_hz", &R::signal, &LeakSignal::frequency_hz)
      .add(closed_loop ? "amplitude_m" : "amplitude_v", &R::signal, &LeakSignal::amplitude)
      .add("target_percent", &R::target_percent)
      .add("coefficients", of_roots(&LeakRoot::coefficient))
      .add("ci95_low", ends(0))
      .add("ci95_high", ends(1))
      .add("log_slopes", of_roots(&LeakRoot::log_slope))
      .add("published_coefficient", &R::comparison, &LeakComparison::published)
      .add("relative_error_percent", &R::comparison, &LeakComparison::relative_error_percent)
      .add("share_at_published_percent", &R::comparison, &LeakComparison::share_percent)
      .add("share_by_rounding_low_percent", &R::comparison, &LeakComparison::share_low_percent)
      .add("share_by_rounding_high_percent", &R::comparison, &LeakComparison::share_high_percent)
      .add("grade", &R::grade)
      .add("note", &R::note)
      .table(result.table.entries);
}

std::string features_csv(const LeakTableResult& result) {
  using R = FeatureRow;
  using datasets::PrintedFeatures;
  using metrics::ResidualFeatures;
  return CsvColumns<R>()
      .add("level", &R::printed, &PrintedFeatures::level)
      .add("coefficient", &R::printed, &PrintedFeatures::coefficient)
      .add("servo_flow_l_per_min", &R::servo_flow_m3_per_s, in_litres_per_minute)
      .add("published_servo_flow_l_per_min", printed(Feature::servo_flow, kLitrePerMinute))
      .add("leak_flow_l_per_min", &R::leak_flow_m3_per_s, in_litres_per_minute)
      .add("published_leak_flow_l_per_min", printed(Feature::leak_flow, kLitrePerMinute))
      .add("mean", &R::features, &ResidualFeatures::mean)
      .add("published_mean", printed(Feature::mean))
      .add("rms", &R::features, &ResidualFeatures::rms)
      .add("published_rms", printed(Feature::rms))
      .add("std", &R::features, &ResidualFeatures::std)
      .add("published_std", printed(Feature::std))
      .table(result.table.features);
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
