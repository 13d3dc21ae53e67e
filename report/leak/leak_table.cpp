#include "report/leak/leak_table.hpp"

#include "report/store/csv_columns.hpp"

namespace rigcal::report {
namespace {

using diagnosis::LeakDrive;
using diagnosis::LeakEntry;

/// Makes a getter that lists the lower or upper ends of the intervals of an entry.
auto ends(double Range::*end) {
  return [end](const LeakEntry& entry) {
    std::vector<double> values;
    for (const auto& range : entry.coefficients_ci95)
      if (range) values.push_back((*range).*end);
    return values;
  };
}

}  // namespace

StoredLeakTable stored(diagnosis::LeakTable table, const datasets::Campaign& campaign,
                       const Provenance& provenance) {
  StoredLeakTable file;
  static_cast<diagnosis::LeakTable&>(file) = std::move(table);
  file.campaign = campaign.name;
  file.notes.emplace();
  file.warnings.emplace();
  file.provenance = stored(provenance);
  return file;
}

std::string leak_table_csv(const diagnosis::LeakTable& table, bool closed_loop) {
  using R = LeakEntry;
  return CsvColumns<R>()
      .add("waveform", &R::drive, &LeakDrive::waveform)
      .add("frequency_hz", &R::drive, &LeakDrive::frequency_hz)
      .add(closed_loop ? "amplitude_m" : "amplitude_v", &R::drive, &LeakDrive::amplitude)
      .members(&R::target_percent, &R::coefficients)
      .add("ci95_low", ends(&Range::low))
      .add("ci95_high", ends(&Range::high))
      .members(&R::log_slopes, &R::published_coefficient, &R::relative_error_percent,
               &R::share_at_published_percent)
      .add("share_by_rounding_low_percent", &R::share_by_rounding_percent, &Range::low)
      .add("share_by_rounding_high_percent", &R::share_by_rounding_percent, &Range::high)
      .members(&R::grade, &R::note)
      .table(table.entries);
}

std::string features_csv(const diagnosis::LeakTable& table) {
  using R = diagnosis::FeatureRow;
  return CsvColumns<R>()
      .members(&R::level, &R::coefficient, &R::servo_flow_l_per_min,
               &R::published_servo_flow_l_per_min, &R::leak_flow_l_per_min,
               &R::published_leak_flow_l_per_min, &R::mean, &R::published_mean, &R::rms,
               &R::published_rms, &R::std, &R::published_std)
      .table(table.features);
}

Table level_table(const datasets::LeakSignal& signal, const diagnosis::PeriodicSeries& series,
                  const diagnosis::PeriodicSeries* healthy) {
  const model::Signal drive =
      datasets::periodic_signal(signal.waveform, signal.amplitude, signal.frequency_hz);
  const std::size_t rows = series.time_s.size();
  const auto output = [](const diagnosis::PeriodicSeries& of, std::size_t i, Eigen::Index k) {
    return of.run.outputs(static_cast<Eigen::Index>(i), k);
  };
  Table table;
  table.add("time_s", series.time_s);
  table.add("drive", rows, [&](std::size_t i) { return drive.value(series.time_s[i]); });
  for (Eigen::Index k = 0; k < series.run.outputs.cols(); ++k)
    table.add(std::string(output_name(diagnosis::kFeatureOutputs[static_cast<std::size_t>(k)])),
              rows, [&](std::size_t i) { return output(series, i, k); });
  if (healthy != nullptr)
    table.add("residual_m", rows,
              [&](std::size_t i) { return output(series, i, 0) - output(*healthy, i, 0); });
  return table;
}

}  // namespace rigcal::report
