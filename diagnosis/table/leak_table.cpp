#include "diagnosis/table/leak_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "common/quantity.hpp"
#include "diagnosis/table/flow_curve.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Feature;

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

LeakGrade leak_grade(const LeakEntry& entry) {
  if (!entry.relative_error_percent) return LeakGrade::outlier;
  const double error = std::abs(*entry.relative_error_percent);
  if (error <= kGoodPercent + kHair) return LeakGrade::within_10;
  return error <= kFairPercent + kHair ? LeakGrade::within_16 : LeakGrade::outlier;
}

/// Compares the published coefficient of an entry with the computed ones.
void compare(FlowCurve& curve, const datasets::PrintedCoefficient& printed, LeakEntry& entry) {
  entry.published_coefficient = printed.value;
  entry.share_at_published_percent = 100.0 * curve.at(printed.value).share();
  const double low = std::max(printed.value - printed.half_digit, 0.5 * printed.value);
  const double at_low = 100.0 * curve.at(low).share();
  const double at_high = 100.0 * curve.at(printed.value + printed.half_digit).share();
  entry.share_by_rounding_percent = {std::min(at_low, at_high), std::max(at_low, at_high)};
  if (!entry.coefficients.empty()) {
    const double nearest = *std::min_element(
        entry.coefficients.begin(), entry.coefficients.end(), [&](double a, double b) {
          return std::abs(std::log(a / printed.value)) < std::abs(std::log(b / printed.value));
        });
    entry.relative_error_percent = 100.0 * (nearest / printed.value - 1.0);
  }
  entry.grade = leak_grade(entry);
}

std::string note_of(const LeakEntry& entry, const datasets::LeakSignal& signal,
                    const FlowCurve& curve) {
  std::string note;
  if (entry.coefficients.empty()) note = not_reached(curve, entry.target_percent / 100.0);
  if (entry.coefficients.size() > 1) {
    note = fmt::format("{} coefficients give this share", entry.coefficients.size());
  }
  if (!entry.coefficients.empty() && !entry.determined) {
    note = join(note, "not determined: the share hardly depends on the coefficient here");
  }
  if (entry.published_coefficient && entry.grade == LeakGrade::outlier) {
    note = join(note, fmt::format("at the published coefficient {:.3g} % leak",
                                  *entry.share_at_published_percent));
  }
  const auto printed = signal.printed.find(entry.target_percent);
  return printed == signal.printed.end() ? note : join(note, printed->second.note);
}

/// Adds a root to an entry, with its slope and interval.
void add_root(const FlowCurve& curve, double coefficient, const LeakTableOptions& options,
              LeakEntry& entry) {
  const RigUncertainty& rig = options.rig;
  entry.coefficients.push_back(coefficient);
  if (rig.indices.empty()) {
    entry.log_slopes.push_back(curve.log_slope(coefficient));
    entry.coefficients_ci95.emplace_back();
    return;
  }
  const Eigen::VectorXd slopes = curve.share_slopes(coefficient, rig.indices);
  const double log_slope = entry.log_slopes.emplace_back(coefficient * slopes(0));
  const Eigen::VectorXd moves = -slopes.tail(slopes.size() - 1) / log_slope;
  // The interval also covers the error in the share due to transient and sampling.
  const double numeric = options.periodic.tolerance / log_slope;
  const double log_error =
      std::sqrt(std::max(0.0, moves.dot(rig.covariance * moves)) + numeric * numeric);
  const double factor = std::exp(metrics::normal_quantile(0.975) * log_error);
  entry.coefficients_ci95.emplace_back(Range{coefficient / factor, coefficient * factor});
}

LeakDrive leak_drive(const PeriodicDrive& drive) {
  LeakDrive described{drive.signal.waveform, drive.signal.frequency_hz, {}, {}};
  const bool closed_loop = drive.rig.controller == model::ControllerKind::pid;
  (closed_loop ? described.amplitude_m : described.amplitude_v) = drive.signal.amplitude;
  return described;
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
    entry.drive = leak_drive(drive);
    entry.target_percent = target;
    for (const double root : curve.roots(share_of, target / 100.0))
      add_root(curve, root, options, entry);
    const auto& slopes = entry.log_slopes;
    if (!slopes.empty()) entry.log_slope = slopes.front();
    entry.determined = !slopes.empty() && std::all_of(slopes.begin(), slopes.end(), [](double s) {
      return std::abs(s) >= kFlatSlope;
    });
    const auto printed = drive.signal.printed.find(target);
    if (printed != drive.signal.printed.end()) compare(curve, printed->second, entry);
    entry.note = note_of(entry, drive.signal, curve);
    column.entries.push_back(std::move(entry));
  }
  if (drive.signal.normal) {
    const double coefficient = drive.signal.normal->value;
    column.normal = {leak_drive(drive), coefficient, 100.0 * curve.at(coefficient).share()};
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
  const auto published = [&](Feature feature, double unit) {
    const auto found = printed.printed.find(feature);
    return found == printed.printed.end() ? std::nullopt : std::optional(found->second / unit);
  };
  const PeriodicFlow flow = curve.at(printed.coefficient);
  PeriodicSeries series =
      series_at(drive, values, printed.coefficient, kMorePeriods * flow.periods, options);
  const datasets::Assumption* scale = settings.assumption(datasets::kResidualScale);
  const Eigen::VectorXd residual = (scale == nullptr ? 1.0 : scale->value) *
                                   (series.run.outputs.col(0) - healthy.run.outputs.col(0));
  const metrics::ResidualFeatures features =
      metrics::residual_features({residual.data(), static_cast<std::size_t>(residual.size())});
  std::vector<double> for_leak_flow;
  const auto leak = printed.printed.find(Feature::leak_flow);
  if (!printed.leaking && leak != printed.printed.end()) {
    curve.scan(settings.lowest_coefficient, 10.0 * printed.coefficient, kScanPerDecade);
    for_leak_flow = curve.roots(leak_of, leak->second);
  }
  return {.level = printed.level,
          .coefficient = printed.coefficient,
          .servo_flow_l_per_min = flow.servo_flow_m3_per_s / kLitrePerMinute,
          .published_servo_flow_l_per_min = published(Feature::servo_flow, kLitrePerMinute),
          .leak_flow_l_per_min = flow.leak_flow_m3_per_s / kLitrePerMinute,
          .published_leak_flow_l_per_min = published(Feature::leak_flow, kLitrePerMinute),
          .mean = features.mean,
          .published_mean = published(Feature::mean, 1.0),
          .rms = features.rms,
          .published_rms = published(Feature::rms, 1.0),
          .std = features.std,
          .published_std = published(Feature::std, 1.0),
          .coefficients_for_published_leak_flow = std::move(for_leak_flow),
          .left_out_of_fit = printed.left_out,
          .reason = unless_empty(printed.reason),
          .series = std::move(series)};
}

LeakSummary summary_of(const std::vector<LeakEntry>& entries) {
  LeakSummary summary;
  double squares = 0.0;
  for (const LeakEntry& entry : entries) {
    if (!entry.published_coefficient) continue;
    ++summary.published;
    summary.within_10_percent += entry.grade == LeakGrade::within_10 ? 1 : 0;
    summary.within_16_percent += entry.grade != LeakGrade::outlier ? 1 : 0;
    const double off = std::log(*entry.share_at_published_percent / entry.target_percent);
    squares += off * off;
  }
  if (summary.published > 0) {
    summary.share_rms_percent = 100.0 * std::sqrt(squares / summary.published);
  }
  return summary;
}

/// Lists every value that the computation used. Values not set in the leak table section come from
/// the campaign.
std::vector<UsedValue> used_values(const datasets::Campaign& campaign,
                                   const datasets::LeakTableSettings& settings,
                                   const model::ParameterValues& values) {
  const auto table = model::parameter_table(campaign.rig.plant);
  std::vector<UsedValue> list;
  const auto add = [&](const model::ParameterSpec& spec, double value, const std::string& source) {
    list.push_back(
        {std::string(spec.name), std::string(spec.key), value, std::string(spec.unit), source});
  };
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].key == "leakage_coefficient") continue;  // the table varies this parameter
    const auto* assumption = settings.assumption(static_cast<int>(i));
    if (!values.given[i] && table[i].kind != model::ParameterKind::plant) continue;
    add(table[i], values.value[i], assumption == nullptr ? "campaign file" : assumption->source);
  }
  if (const auto* scale = settings.assumption(datasets::kResidualScale)) {
    add(datasets::assumption_spec(campaign.rig.plant, datasets::kResidualScale), scale->value,
        scale->source);
  }
  return list;
}

}  // namespace

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
                     "leakage_area is zero, so there is no leak for any coefficient: expected an "
                     "area above zero");
  }
  LeakTable table;
  table.assumptions = used_values(campaign, settings, values);
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
    if (column.normal) table.normal.push_back(*column.normal);
  }
  table.fixed_combinations = fixed_combinations(campaign, values);
  table.summary = summary_of(table.entries);
  return table;
}

}  // namespace rigcal::diagnosis
