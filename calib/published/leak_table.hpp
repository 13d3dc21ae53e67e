#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/published/periodic_flow.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::calib {

/// How well the computed coefficient agrees with the published one.
enum class LeakGrade { within_10, within_16, outlier, not_published };
std::string_view to_string(LeakGrade grade);

struct LeakRoot {
  double coefficient = 0.0;
  double log_slope = 0.0;  ///< d ln share / d ln coefficient
  /// Standard error of ln coefficient due to the errors of the rig's values; absent if no error is
  /// known.
  std::optional<double> log_error;
  /// Returns false on a plateau, where a change of 1 % in the share moves the coefficient by more
  /// than 5 %.
  bool determined() const;
  /// Returns the 95 % interval of the coefficient. Both ends are positive, because the interval is
  /// symmetric in the logarithm.
  std::optional<std::array<double, 2>> ci95() const;
};

/// Comparison of the published coefficient of an entry with the computed one.
struct LeakComparison {
  double published = 0.0;
  double share_percent = 0.0;  ///< computed share at the published coefficient
  /// At the ends of the interval within which the published value may have been rounded.
  double share_low_percent = 0.0;
  double share_high_percent = 0.0;
  /// Error of the nearest root; absent if there is no root.
  std::optional<double> relative_error_percent;
};

/// One cell of the table: a signal and a target share.
struct LeakEntry {
  datasets::LeakSignal signal;
  double target_percent = 0.0;
  std::vector<LeakRoot> roots;  ///< all roots, in increasing order
  std::optional<LeakComparison> comparison;
  LeakGrade grade = LeakGrade::not_published;
  std::string note;  ///< why there is no root or more than one, or a comment on an outlier
};

/// The published coefficient of the rig without a fault.
struct NormalEntry {
  datasets::LeakSignal signal;
  double coefficient = 0.0;
  double share_percent = 0.0;  ///< computed share at this coefficient
};

/// Computed values for one row of the published flows and features.
struct FeatureRow {
  datasets::PrintedFeatures printed;
  double servo_flow_m3_per_s = 0.0;
  double leak_flow_m3_per_s = 0.0;
  metrics::ResidualFeatures features;  ///< from the scaled residual: leaking minus healthy position
  /// Coefficients that give the published leak flow; only for the rig without a fault.
  std::vector<double> coefficients_for_leak_flow;
  PeriodicSeries series;  ///< one period, with the outputs in kFeatureOutputs
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

struct LeakTable {
  std::vector<LeakEntry> entries;  ///< signal by signal, with the targets of each in order
  std::vector<NormalEntry> normals;
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

}  // namespace rigcal::calib
