#include "report/leak/leak_table.hpp"

namespace rigcal::report {
namespace {

using datasets::Feature;

std::optional<Range> range_of(const std::optional<std::array<double, 2>>& ends) {
  return ends ? std::optional(Range{ends->front(), ends->back()}) : std::nullopt;
}

/// Lists every value that the computation used. Values not set in the leak table section come from
/// the campaign.
std::vector<StoredAssumption> assumptions_of(const LeakTableResult& result) {
  const auto values = datasets::leak_table_values(result.campaign, result.settings);
  const auto table = model::parameter_table(result.campaign.rig.plant);
  std::vector<StoredAssumption> list;
  const auto add = [&](const model::ParameterSpec& spec, double value, const std::string& source) {
    list.push_back(
        {std::string(spec.name), std::string(spec.key), value, std::string(spec.unit), source});
  };
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].key == "leakage_coefficient") continue;  // the table varies this parameter
    const auto* assumption = result.settings.assumption(static_cast<int>(i));
    if (!values.given[i] && table[i].kind != model::ParameterKind::plant) continue;
    add(table[i], values.value[i], assumption == nullptr ? "campaign file" : assumption->source);
  }
  if (const auto* scale = result.settings.assumption(datasets::kResidualScale)) {
    add(datasets::assumption_spec(result.campaign.rig.plant, datasets::kResidualScale),
        scale->value, scale->source);
  }
  return list;
}

/// Starts an entry of the table, or the row of the fault-free rig, with its drive.
template <typename Entry>
Entry with_drive(const LeakTableResult& result, const datasets::LeakSignal& signal) {
  Entry entry;
  entry.waveform = signal.waveform;
  entry.frequency_hz = signal.frequency_hz;
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  (closed_loop ? entry.amplitude_m : entry.amplitude_v) = signal.amplitude;
  return entry;
}

StoredLeakEntry stored(const LeakTableResult& result, const calib::LeakEntry& found) {
  auto entry = with_drive<StoredLeakEntry>(result, found.signal);
  entry.target_percent = found.target_percent;
  entry.determined = !found.roots.empty();
  auto& ranges = entry.coefficients_ci95.emplace();
  auto& slopes = entry.log_slopes.emplace();
  for (const calib::LeakRoot& root : found.roots) {
    entry.coefficients.push_back(root.coefficient);
    ranges.push_back(range_of(root.ci95()));
    slopes.push_back(root.log_slope);
    entry.determined = entry.determined && root.determined();
  }
  if (!found.roots.empty()) entry.log_slope = found.roots.front().log_slope;
  if (const auto& c = found.comparison) {
    entry.published_coefficient = c->published;
    entry.relative_error_percent = c->relative_error_percent;
    entry.share_at_published_percent = c->share_percent;
    entry.share_by_rounding_percent = Range{c->share_low_percent, c->share_high_percent};
  }
  entry.grade = found.grade;
  entry.note = found.note;
  return entry;
}

StoredFeatures stored(const calib::FeatureRow& row) {
  const auto printed = [&](Feature feature, double unit) {
    const auto found = row.printed.printed.find(feature);
    return found == row.printed.printed.end() ? std::nullopt : std::optional(found->second / unit);
  };
  return {.level = row.printed.level,
          .coefficient = row.printed.coefficient,
          .servo_flow_l_per_min = row.servo_flow_m3_per_s / kLitrePerMinute,
          .published_servo_flow_l_per_min = printed(Feature::servo_flow, kLitrePerMinute),
          .leak_flow_l_per_min = row.leak_flow_m3_per_s / kLitrePerMinute,
          .published_leak_flow_l_per_min = printed(Feature::leak_flow, kLitrePerMinute),
          .mean = row.features.mean,
          .published_mean = printed(Feature::mean, 1.0),
          .rms = row.features.rms,
          .published_rms = printed(Feature::rms, 1.0),
          .std = row.features.std,
          .published_std = printed(Feature::std, 1.0),
          .coefficients_for_published_leak_flow = row.coefficients_for_leak_flow,
          .left_out_of_fit = row.printed.left_out,
          .reason = unless_empty(row.printed.reason)};
}

}  // namespace

StoredLeakTable stored(const LeakTableResult& result) {
  StoredLeakTable file;
  file.campaign = result.campaign.name;
  file.notes = result.notes;
  file.warnings = result.warnings;
  file.assumptions = assumptions_of(result);
  file.fixed_combinations = result.table.fixed_combinations;
  for (const calib::LeakEntry& entry : result.table.entries)
    file.entries.push_back(stored(result, entry));
  file.summary = result.table.summary;
  for (const calib::NormalEntry& each : result.table.normals) {
    auto& normal = file.normal.emplace_back(with_drive<StoredNormal>(result, each.signal));
    normal.published_coefficient = each.coefficient;
    normal.share_at_published_percent = each.share_percent;
  }
  for (const calib::FeatureRow& row : result.table.features) file.features.push_back(stored(row));
  file.provenance = stored(result.provenance);
  return file;
}

}  // namespace rigcal::report
