#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"
#include "common/range.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "diagnosis/table/periodic_flow.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

/// How well the computed coefficient agrees with the published one.
enum class LeakGrade { within_10, within_16, outlier, not_published };
RIGCAL_WORDS(LeakGrade, within_10, "within 10 %", within_16, "within 16 %", outlier, "outlier",
             not_published, "not published")

/// Drive signal of one entry in a leak table.
struct LeakDrive {
  datasets::Waveform waveform = datasets::Waveform::sine;
  double frequency_hz = 0.0;
  Omittable<double> amplitude_m;  ///< in a closed loop
  Omittable<double> amplitude_v;  ///< in an open loop
  RIGCAL_DESCRIBE(waveform, frequency_hz, amplitude_m, amplitude_v)

  std::optional<double> amplitude() const { return amplitude_m ? amplitude_m : amplitude_v; }
};

/// One cell of the table: a signal and a target share.
struct LeakEntry {
  Inlined<LeakDrive> drive;
  double target_percent = 0.0;
  std::vector<double> coefficients;  ///< all roots, in increasing order
  /// 95 % interval of each coefficient; null without errors of the rig's values. Both ends are
  /// positive, because the interval is symmetric in the logarithm.
  Later<std::vector<std::optional<Range>>> coefficients_ci95;
  Later<std::vector<double>> log_slopes;  ///< d ln share / d ln coefficient at each coefficient
  std::optional<double> log_slope;        ///< slope at the first coefficient
  /// False without a root or on a plateau, where a change of 1 % in the share moves a coefficient
  /// by more than 5 %.
  bool determined = false;
  std::optional<double> published_coefficient;
  std::optional<double> relative_error_percent;  ///< error of the nearest root
  std::optional<double> share_at_published_percent;
  /// Shares at the ends of the interval within which the published value may have been rounded.
  std::optional<Range> share_by_rounding_percent;
  LeakGrade grade = LeakGrade::not_published;
  std::string note;  ///< why there is no root or more than one, or a comment on an outlier
  RIGCAL_DESCRIBE(drive, target_percent, coefficients, coefficients_ci95, log_slopes, log_slope,
                  determined, published_coefficient, relative_error_percent,
                  share_at_published_percent, share_by_rounding_percent, grade, note)
};

/// The published coefficient of the rig without a fault.
struct NormalEntry {
  Inlined<LeakDrive> drive;
  double published_coefficient = 0.0;
  double share_at_published_percent = 0.0;
  RIGCAL_DESCRIBE(drive, published_coefficient, share_at_published_percent)
};

/// Computed values for one row of the published flows and features.
struct FeatureRow {
  std::string level;
  double coefficient = 0.0;
  double servo_flow_l_per_min = 0.0;
  std::optional<double> published_servo_flow_l_per_min;
  double leak_flow_l_per_min = 0.0;
  std::optional<double> published_leak_flow_l_per_min;
  double mean = 0.0;  ///< from the scaled residual, as are rms and std: leaking minus healthy
  std::optional<double> published_mean;
  double rms = 0.0;
  std::optional<double> published_rms;
  double std = 0.0;
  std::optional<double> published_std;
  /// Only for the rig without a fault.
  std::vector<double> coefficients_for_published_leak_flow;
  std::vector<datasets::Feature> left_out_of_fit;
  std::optional<std::string> reason;  ///< why they are left out
  PeriodicSeries series;              ///< one period, with the outputs in kFeatureOutputs
  RIGCAL_DESCRIBE(level, coefficient, servo_flow_l_per_min, published_servo_flow_l_per_min,
                  leak_flow_l_per_min, published_leak_flow_l_per_min, mean, published_mean, rms,
                  published_rms, std, published_std, coefficients_for_published_leak_flow,
                  left_out_of_fit, reason)
};
inline constexpr std::array kFeatureOutputs{model::Output::position, model::Output::servo_flow,
                                            model::Output::leakage_flow, model::Output::work_flow};

/// A combination of values that the tables determine although they do not determine the individual
/// values.
struct FixedCombination {
  std::string name;     ///< for example "loop_gain_per_s"
  std::string formula;  ///< for example "kp k_sv C_d w sqrt(P_s / rho) / A"
  std::string unit;
  double value = 0.0;
  RIGCAL_DESCRIBE(name, formula, value, unit)
};

/// Agreement with the published numbers, over all entries that have a published number.
struct LeakSummary {
  int published = 0;
  int within_10_percent = 0;
  int within_16_percent = 0;                ///< includes those within 10 %
  std::optional<double> share_rms_percent;  ///< root mean square of ln(share / target), in percent
  RIGCAL_DESCRIBE(published, within_10_percent, within_16_percent, share_rms_percent)
};

/// A value that the computation used.
struct UsedValue {
  std::string name;    ///< name in result files: "piston_area_m2"
  std::string key;     ///< key in campaign files
  double value = 0.0;  ///< SI
  std::string unit;
  std::string source;
  RIGCAL_DESCRIBE(name, key, value, unit, source)
};

struct LeakTable {
  std::vector<UsedValue> assumptions;
  std::vector<LeakEntry> entries;  ///< signal by signal, with the targets of each in order
  std::vector<NormalEntry> normal;
  std::optional<PeriodicSeries> healthy;  ///< series of the feature signal, without a leak
  std::vector<FeatureRow> features;
  std::vector<FixedCombination> fixed_combinations;
  LeakSummary summary;
};

/// Uncertainty of the rig's values from a fit.
struct RigUncertainty {
  std::vector<int> indices;    ///< rows of the parameter table
  Eigen::MatrixXd covariance;  ///< SI, shape (indices, indices)
};

struct LeakTableOptions {
  PeriodicOptions periodic;
  int series_samples = 2000;  ///< number of samples in the period from which features are computed
  int threads = 1;            ///< the results are bitwise identical for any number
  RigUncertainty rig;         ///< if empty, coefficients get no interval
};

/// Computes the leak table of a rig. For each signal and target share, it contains all leakage
/// coefficients at which that share of the servo flow leaks, and the published value.
///
/// If the rig's values p are estimates with covariance S, the coefficients C at a share s are
/// uncertain as well. With s(C, p) constant, d ln C / dp = -(d ln s / dp) / (d ln s / d ln C) = g.
/// To first order, the variance of ln C is g^T S g plus the variance due to the numerical error of
/// the share.
///
/// @param settings  signals, targets, published numbers, assumptions
/// @throws NoResultError  if a simulation fails or takes too long to become periodic; states which
///                        one and why
/// @throws InputError     if a parameter of the plant has no value
LeakTable leak_table(const datasets::Campaign& campaign,
                     const datasets::LeakTableSettings& settings, const LeakTableOptions& options);

/// Computes the loop gain, m / b and the leak conductance, or those of them that exist for the rig.
std::vector<FixedCombination> fixed_combinations(const datasets::Campaign& campaign,
                                                 const model::ParameterValues& values);

}  // namespace rigcal::diagnosis
