#include "calib/published/leak_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/published/flow_curve.hpp"
#include "common/error.hpp"
#include "common/parallel.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// Number of points per decade in a scan over the coefficient.
constexpr int kScanPerDecade = 4;
/// Limits of the grades in docs/paper.md. A coefficient printed as 0.3 already has a rounding error
/// of up to 17 %.
constexpr double kGoodPercent = 10.0;
constexpr double kFairPercent = 16.0;
/// If d ln share / d ln coefficient is below this, a change of 1 % in the share corresponds to more
/// than 5 % in the coefficient.
constexpr double kFlatSlope = 0.2;
/// Tolerance for comparing errors with whole percentages, so that rounding does not change a grade.
constexpr double kHair = 1e-9;

double share_of(const PeriodicFlow& flow) { return flow.share(); }
double leak_of(const PeriodicFlow& flow) { return flow.leak_flow_m3_per_s; }

std::string join(const std::string& a, const std::string& b) {
  return a.empty() ? b : b.empty() ? a : a + "; " + b;
}

/// Explains why no coefficient reaches the target.
std::string not_reached(const FlowCurve& curve, double target) {
  const auto& known = curve.simulated();
  const auto highest = std::max_element(
      known.begin(), known.end(),
      [](const auto& a, const auto& b) { return a.second.share() < b.second.share(); });
  if (known.begin()->second.share() > target) {
    return fmt::format("not found: already {:.3g} % leak at the lowest coefficient, {:g}",
                       100.0 * known.begin()->second.share(), known.begin()->first);
  }
  std::string note = fmt::format("not reached: at most {:.3g} % leak, at the coefficient {:.3g}",
                                 100.0 * highest->second.share(), highest->first);
  if (highest->second.saturated > 0.0) {
    note += fmt::format(", where the valve command is at its limit for {:.0f} % of the time",
                        100.0 * highest->second.saturated);
  }
  return note;
}

LeakGrade leak_grade(const LeakComparison& comparison) {
  if (!comparison.relative_error_percent) return LeakGrade::outlier;
  const double error = std::abs(*comparison.relative_error_percent);
  if (error <= kGoodPercent + kHair) return LeakGrade::within_10;
  return error <= kFairPercent + kHair ? LeakGrade::within_16 : LeakGrade::outlier;
}

LeakComparison compare(FlowCurve& curve, const datasets::PrintedCoefficient& printed,
                       const std::vector<LeakRoot>& roots) {
  LeakComparison comparison;
  comparison.published = printed.value;
  comparison.share_percent = 100.0 * curve.at(printed.value).share();
  const double low = std::max(printed.value - printed.half_digit, 0.5 * printed.value);
  const double at_low = 100.0 * curve.at(low).share();
  const double at_high = 100.0 * curve.at(printed.value + printed.half_digit).share();
  comparison.share_low_percent = std::min(at_low, at_high);
  comparison.share_high_percent = std::max(at_low, at_high);
  if (roots.empty()) return comparison;
  const auto nearest =
      std::min_element(roots.begin(), roots.end(), [&](const auto& a, const auto& b) {
        return std::abs(std::log(a.coefficient / printed.value)) <
               std::abs(std::log(b.coefficient / printed.value));
      });
  comparison.relative_error_percent = 100.0 * (nearest->coefficient / printed.value - 1.0);
  return comparison;
}

std::string note_of(const LeakEntry& entry, const FlowCurve& curve) {
  std::string note;
  if (entry.roots.empty()) note = not_reached(curve, entry.target_percent / 100.0);
  if (entry.roots.size() > 1) {
    note = fmt::format("{} coefficients leak this share", entry.roots.size());
  }
  if (std::any_of(entry.roots.begin(), entry.roots.end(),
                  [](const LeakRoot& root) { return !root.determined(); })) {
    note = join(note, "not determined: the share hardly depends on the coefficient here");
  }
  if (entry.comparison && entry.grade == LeakGrade::outlier) {
    note = join(note, fmt::format("at the published coefficient {:.3g} % leak",
                                  entry.comparison->share_percent));
  }
  const auto printed = entry.signal.printed.find(entry.target_percent);
  return printed == entry.signal.printed.end() ? note : join(note, printed->second.note);
}

LeakRoot root_at(const FlowCurve& curve, double coefficient, const LeakTableOptions& options) {
  const RigUncertainty& rig = options.rig;
  LeakRoot root;
  root.coefficient = coefficient;
  if (rig.indices.empty()) {
    root.log_slope = curve.log_slope(coefficient);
    return root;
  }
  const Eigen::VectorXd slopes = curve.share_slopes(coefficient, rig.indices);
  root.log_slope = coefficient * slopes(0);
  const Eigen::VectorXd moves = -slopes.tail(slopes.size() - 1) / root.log_slope;
  // The interval also covers the error in the share due to transient and sampling.
  const double numeric = options.periodic.tolerance / root.log_slope;
  root.log_error = std::sqrt(std::max(0.0, moves.dot(rig.covariance * moves)) + numeric * numeric);
  return root;
}

struct Column {
  std::vector<LeakEntry> entries;
  std::optional<NormalEntry> normal;
};

Column column_of(const PeriodicDrive& drive, const model::ParameterValues& values,
                 const datasets::LeakTableSettings& settings, const LeakTableOptions& options) {
  FlowCurve curve(drive, values, options.periodic);
  curve.scan(settings.lowest_coefficient, settings.highest_coefficient, kScanPerDecade);
  Column column;
  for (const double target : settings.targets_percent) {
    LeakEntry entry;
    entry.signal = drive.signal;
    entry.target_percent = target;
    for (const double root : curve.roots(share_of, target / 100.0)) {
      entry.roots.push_back(root_at(curve, root, options));
    }
    const auto printed = drive.signal.printed.find(target);
    if (printed != drive.signal.printed.end()) {
      entry.comparison = compare(curve, printed->second, entry.roots);
      entry.grade = leak_grade(*entry.comparison);
    }
    entry.note = note_of(entry, curve);
    column.entries.push_back(std::move(entry));
  }
  if (drive.signal.normal) {
    const double coefficient = drive.signal.normal->value;
    column.normal = {drive.signal, coefficient, 100.0 * curve.at(coefficient).share()};
  }
  return column;
}

/// Simulates one period with a given coefficient, after as many periods as the flows needed to
/// become periodic.
PeriodicSeries series_at(const PeriodicDrive& drive, model::ParameterValues values,
                         double coefficient, int periods, const LeakTableOptions& options) {
  values.set("leakage_coefficient", coefficient);
  PeriodicSeries series = periodic_series(drive, values, {}, kFeatureOutputs, periods,
                                          options.series_samples, options.periodic.simulation);
  if (!series.run.ok()) {
    throw NoResultError(fmt::format("{} at leakage_coefficient = {:.6g}: {} at {:.6g} s: {}",
                                    drive.signal.name(), coefficient, to_string(series.run.status),
                                    series.run.failed_at_s, series.run.reason));
  }
  return series;
}

/// Features need the position, which settles more slowly than the mean flows. The number of periods
/// is therefore multiplied by this factor.
constexpr int kMorePeriods = 2;

FeatureRow feature_row(const PeriodicDrive& drive, const model::ParameterValues& values,
                       const datasets::LeakTableSettings& settings,
                       const datasets::PrintedFeatures& printed, const PeriodicSeries& healthy,
                       const LeakTableOptions& options) {
  FlowCurve curve(drive, values, options.periodic);
  FeatureRow row;
  row.printed = printed;
  const PeriodicFlow flow = curve.at(printed.coefficient);
  row.servo_flow_m3_per_s = flow.servo_flow_m3_per_s;
  row.leak_flow_m3_per_s = flow.leak_flow_m3_per_s;
  row.series = series_at(drive, values, printed.coefficient, kMorePeriods * flow.periods, options);
  const datasets::Assumption* scale = settings.assumption(datasets::kResidualScale);
  const Eigen::VectorXd residual = (scale == nullptr ? 1.0 : scale->value) *
                                   (row.series.run.outputs.col(0) - healthy.run.outputs.col(0));
  row.features =
      metrics::residual_features({residual.data(), static_cast<std::size_t>(residual.size())});
  const auto leak = printed.printed.find(datasets::Feature::leak_flow);
  if (!printed.leaking && leak != printed.printed.end()) {
    curve.scan(settings.lowest_coefficient, 10.0 * printed.coefficient, kScanPerDecade);
    row.coefficients_for_leak_flow = curve.roots(leak_of, leak->second);
  }
  return row;
}

LeakSummary summary_of(const std::vector<LeakEntry>& entries) {
  LeakSummary summary;
  double squares = 0.0;
  for (const LeakEntry& entry : entries) {
    if (!entry.comparison) continue;
    ++summary.published;
    summary.within_10_percent += entry.grade == LeakGrade::within_10 ? 1 : 0;
    summary.within_16_percent += entry.grade != LeakGrade::outlier ? 1 : 0;
    const double off = std::log(entry.comparison->share_percent / entry.target_percent);
    squares += off * off;
  }
  if (summary.published > 0) {
    summary.share_rms_percent = 100.0 * std::sqrt(squares / summary.published);
  }
  return summary;
}

}  // namespace

std::string_view to_string(LeakGrade grade) {
  switch (grade) {
    case LeakGrade::within_10:
      return "within 10 %";
    case LeakGrade::within_16:
      return "within 16 %";
    case LeakGrade::outlier:
      return "outlier";
    case LeakGrade::not_published:
      return "not published";
  }
  return "";
}

bool LeakRoot::determined() const { return std::abs(log_slope) >= kFlatSlope; }

std::optional<std::array<double, 2>> LeakRoot::ci95() const {
  if (!log_error) return std::nullopt;
  const double factor = std::exp(metrics::normal_quantile(0.975) * *log_error);
  return std::array{coefficient / factor, coefficient * factor};
}

std::vector<FixedCombination> fixed_combinations(const datasets::Campaign& campaign,
                                                 const model::ParameterValues& values) {
  std::vector<FixedCombination> combinations;
  const double damping = values["damping"];
  if (campaign.rig.controller == model::ControllerKind::pid) {
    combinations.push_back({"loop_gain_per_s", "kp k_sv C_d w sqrt(P_s / rho) / A", "1/s",
                            values["kp"] * values["valve_gain"] * values["discharge_coefficient"] *
                                values["area_gradient"] *
                                std::sqrt(values["supply_pressure"] / values["density"]) /
                                values["piston_area"]});
  }
  if (damping > 0.0) {
    combinations.push_back({"mass_over_damping_s", "m / b", "s", values["mass"] / damping});
    combinations.push_back({"leak_conductance", "w_leak sqrt(b)", "m2 (N s/m)^(1/2)",
                            values["leakage_area"] * std::sqrt(damping)});
  }
  return combinations;
}

LeakTable leak_table(const datasets::Campaign& campaign,
                     const datasets::LeakTableSettings& settings, const LeakTableOptions& options) {
  const model::ParameterValues values = datasets::leak_table_values(campaign, settings);
  if (!(values["leakage_area"] > 0.0)) {
    throw InputError({campaign.file.string()},
                     "leakage_area is zero, so no coefficient leaks: expected an area above zero");
  }
  LeakTable table;
  std::vector<Column> columns(settings.signals.size());
  table.features.resize(settings.features.size());
  if (settings.feature_signal && !settings.features.empty()) {
    const PeriodicDrive drive{campaign.rig, *settings.feature_signal};
    FlowCurve curve(drive, values, options.periodic);
    const int periods = kMorePeriods * curve.at(settings.lowest_coefficient).periods;
    table.healthy = series_at(drive, values, 0.0, periods, options);
  }
  parallel_for(columns.size() + table.features.size(), options.threads, [&](std::size_t i) {
    if (i < columns.size()) {
      columns[i] = column_of({campaign.rig, settings.signals[i]}, values, settings, options);
    } else {
      const std::size_t row = i - columns.size();
      table.features[row] = feature_row({campaign.rig, *settings.feature_signal}, values, settings,
                                        settings.features[row], *table.healthy, options);
    }
  });
  for (Column& column : columns) {
    for (LeakEntry& entry : column.entries) table.entries.push_back(std::move(entry));
    if (column.normal) table.normals.push_back(std::move(*column.normal));
  }
  table.fixed_combinations = fixed_combinations(campaign, values);
  table.summary = summary_of(table.entries);
  return table;
}

}  // namespace rigcal::calib
