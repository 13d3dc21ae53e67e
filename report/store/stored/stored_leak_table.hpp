#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/published/leak_table.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_provenance.hpp"

// leak_table.json (docs/command-line.md).

namespace rigcal::report {

template <>
inline std::vector<calib::LeakGrade> every() {
  using calib::LeakGrade;
  return {LeakGrade::within_10, LeakGrade::within_16, LeakGrade::outlier, LeakGrade::not_published};
}
template <>
inline std::vector<datasets::Feature> every() {
  using datasets::Feature;
  return {Feature::servo_flow, Feature::leak_flow, Feature::mean, Feature::rms, Feature::std};
}

inline constexpr const char* kLeakTableSchema = "rigcal.leak_table/1";

/// A value that the computation used.
struct StoredAssumption {
  std::string name;  ///< name in result files: "piston_area_m2"
  std::string key;   ///< key in campaign files
  double value = 0.0;
  std::string unit;
  std::string source;
  RIGCAL_DESCRIBE(name, key, value, unit, source)
};

/// A cell of the table: a signal and a target share.
struct StoredLeakEntry {
  datasets::Waveform waveform = datasets::Waveform::sine;
  double frequency_hz = 0.0;
  Omittable<double> amplitude_m;  ///< in a closed loop
  Omittable<double> amplitude_v;  ///< in an open loop
  double target_percent = 0.0;
  std::vector<double> coefficients;  ///< all roots, increasing
  Omittable<std::vector<std::optional<Range>>> coefficients_ci95;
  Omittable<std::vector<double>> log_slopes;
  std::optional<double> log_slope;
  bool determined = false;
  std::optional<double> published_coefficient;
  std::optional<double> relative_error_percent;
  std::optional<double> share_at_published_percent;
  std::optional<Range> share_by_rounding_percent;
  calib::LeakGrade grade = calib::LeakGrade::not_published;
  std::string note;
  RIGCAL_DESCRIBE(waveform, frequency_hz, amplitude_m, amplitude_v, target_percent, coefficients,
                  coefficients_ci95, log_slopes, log_slope, determined, published_coefficient,
                  relative_error_percent, share_at_published_percent, share_by_rounding_percent,
                  grade, note)
};

/// The published coefficient for the rig without a fault.
struct StoredNormal {
  datasets::Waveform waveform = datasets::Waveform::sine;
  double frequency_hz = 0.0;
  Omittable<double> amplitude_m;
  Omittable<double> amplitude_v;
  double published_coefficient = 0.0;
  double share_at_published_percent = 0.0;
  RIGCAL_DESCRIBE(waveform, frequency_hz, amplitude_m, amplitude_v, published_coefficient,
                  share_at_published_percent)
};

/// Flows and features at a published leak level.
struct StoredFeatures {
  std::string level;
  double coefficient = 0.0;
  double servo_flow_l_per_min = 0.0;
  std::optional<double> published_servo_flow_l_per_min;
  double leak_flow_l_per_min = 0.0;
  std::optional<double> published_leak_flow_l_per_min;
  double mean = 0.0;
  std::optional<double> published_mean;
  double rms = 0.0;
  std::optional<double> published_rms;
  double std = 0.0;
  std::optional<double> published_std;
  std::vector<double> coefficients_for_published_leak_flow;
  std::vector<datasets::Feature> left_out_of_fit;
  std::optional<std::string> reason;
  RIGCAL_DESCRIBE(level, coefficient, servo_flow_l_per_min, published_servo_flow_l_per_min,
                  leak_flow_l_per_min, published_leak_flow_l_per_min, mean, published_mean, rms,
                  published_rms, std, published_std, coefficients_for_published_leak_flow,
                  left_out_of_fit, reason)
};

struct StoredLeakTable {
  std::string status = "done";
  std::string schema = kLeakTableSchema;
  std::string campaign;
  std::string share = "mean |Q_leak| / mean |Q_servo| over one period, periodic";
  std::string residual = "|position without leak - position with leak| times residual_scale";
  std::string interval =
      "95 % of each coefficient by the covariance of the fit, to first order in the fit's values: "
      "ln C moves by -(d ln s / dp) / (d ln s / d ln C); null without a fit";
  Omittable<std::vector<std::string>> notes;
  Omittable<std::vector<std::string>> warnings;
  std::vector<StoredAssumption> assumptions;
  std::vector<calib::FixedCombination> fixed_combinations;
  std::vector<StoredLeakEntry> entries;
  calib::LeakSummary summary;
  std::vector<StoredNormal> normal;
  std::vector<StoredFeatures> features;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, campaign, share, residual, interval, notes, warnings, assumptions,
                  fixed_combinations, entries, summary, normal, features, provenance)
};

}  // namespace rigcal::report
