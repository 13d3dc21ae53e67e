#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "metrics/residual_features.hpp"
#include "report/store/stored/stored_leak.hpp"
#include "report/store/stored/stored_provenance.hpp"

// diagnosis.json (docs/diagnosis.md).

namespace rigcal::report {

inline constexpr const char* kDiagnosisSchema = "rigcal.diagnosis/1";

struct StoredDiagnosisSettings {
  Keyed<double> limits_percent;  ///< upper limit of every class except the last
  double least_probability = 0.0, false_alarms = 0.0, detection = 0.0;
  /// Present if the leak is laminar. Each `leakage_coefficient` of the file is then the conductance
  /// of the leak [m3/(s Pa)].
  Omittable<datasets::LeakLaw> leak_law;
  RIGCAL_DESCRIBE(limits_percent, least_probability, false_alarms, detection, leak_law)

  bool is_laminar() const { return leak_law == datasets::LeakLaw::laminar; }
};

/// A row of a leak table that serves as a class limit.
struct StoredClassLimit {
  std::string signal;
  double share_percent = 0.0;
  std::optional<datasets::LeakClass> class_;  ///< this is the upper limit of the class
  std::vector<double> coefficients;
  std::vector<std::optional<Range>> coefficients_ci95;  ///< one per coefficient
  RIGCAL_DESCRIBE(signal, share_percent, class_, coefficients, coefficients_ci95)
};

/// Verdict on one state of the machine.
struct StoredState {
  std::string state;
  std::optional<std::string> leak_level, specimen, date;
  std::string sentence;
  std::optional<std::string> failure;
  bool is_reference = false;
  std::vector<std::string> conditions;
  std::vector<std::string> left_out;  ///< condition and reason
  Inlined<StoredLeak> leak;
  std::optional<double> leak_area_m2;
  std::optional<Range> leak_area_ci95_m2;
  std::optional<std::string> duty;  ///< signal to which the leak share refers
  std::optional<diagnosis::LimitDistance> nearest_limit;
  std::optional<diagnosis::SignalsAgreement> agreement;  ///< absent for a single signal
  RIGCAL_DESCRIBE(state, leak_level, specimen, date, sentence, failure, is_reference, conditions,
                  left_out, leak, leak_area_m2, leak_area_ci95_m2, duty, nearest_limit, agreement)
};

/// Predictions are limited to this multiple of the observed time span.
inline constexpr double kAhead = 3.0;

struct StoredDiagnosedRecord {
  std::string condition;
  std::optional<int> repeat;  ///< from 1; absent for the average
  int repeats_averaged = 1;
  std::string signal;
  int reference_repeats = 0;
  bool is_reference = false;
  std::optional<std::string> failure;
  Inlined<StoredLeak> leak;
  std::optional<double> unbounded_leakage_coefficient;
  bool undecided = false;
  std::optional<bool> explained_by_leak;
  metrics::ByFeature<std::optional<double>> features;
  std::optional<double> parity_rms_m, misfit_rms_m, noise_rms_m, log_slope;
  std::optional<datasets::LeakClass> class_by_features, class_by_features_of_other_signals,
      true_class;
  std::optional<double> true_share_percent;
  std::vector<std::string> warnings;
  RIGCAL_DESCRIBE(condition, repeat, repeats_averaged, signal, reference_repeats, is_reference,
                  failure, leak, unbounded_leakage_coefficient, undecided, explained_by_leak,
                  features, parity_rms_m, misfit_rms_m, noise_rms_m, log_slope, class_by_features,
                  class_by_features_of_other_signals, true_class, true_share_percent, warnings)

  bool is_average() const { return !repeat; }
};

/// The smallest detectable leak of a signal [L/min].
struct StoredSmallestLeak {
  std::string signal;
  int repeats_averaged = 1;
  std::optional<double> averaged, single;
  std::optional<double> averaged_share_percent;
  std::optional<double> repeat_sd_m, healthy_leak_m;
  std::optional<std::string> reason;  ///< why there is no such leak
  /// Present if `averaged` and `single` apply to records from another day than their reference.
  Omittable<bool> of_another_day;
  Omittable<double> averaged_same_day, single_same_day;
  RIGCAL_DESCRIBE(signal, repeats_averaged, averaged, single, averaged_share_percent, repeat_sd_m,
                  healthy_leak_m, reason, of_another_day, averaged_same_day, single_same_day)
};

/// A quantity that differs between days.
struct StoredDayQuantity {
  std::string quantity, meaning, unit;
  double sd = 0.0;
  std::string sd_from;
  RIGCAL_DESCRIBE(quantity, meaning, unit, sd, sd_from)
};

/// How the variation between days was taken into account.
struct StoredBetweenDays {
  std::vector<std::string> other_days;  ///< dates of records with a reference from another day
  std::string source;                   ///< "usual", "stated", "estimated"
  double factor = 1.0;                  ///< estimated factor on the usual sizes
  std::optional<double> freedom;  ///< degrees of freedom of the factor; absent if not estimated
  int healthy_dates = 0;
  std::vector<StoredDayQuantity> quantities;
  std::optional<std::string> sentence;
  RIGCAL_DESCRIBE(other_days, source, factor, freedom, healthy_dates, quantities, sentence)
};

struct StoredDiagnosis {
  LeakStatus status = LeakStatus::failed;
  std::string schema = kDiagnosisSchema;
  std::vector<std::string> reasons;  ///< why it was declined
  std::string campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  StoredDiagnosisSettings settings;
  std::vector<StoredClassLimit> class_limits;  ///< empty without a leak table
  std::vector<StoredState> states;
  std::vector<diagnosis::LeakTrend> trends;
  std::vector<StoredDiagnosedRecord> records;
  diagnosis::Confusion confusion;  ///< this and the accuracies: fitted leak, single repeats
  std::optional<double> accuracy;
  std::optional<Range> accuracy_ci95;
  diagnosis::Methods methods;
  std::vector<StoredSmallestLeak> smallest_leak_l_per_min;  ///< one per signal
  Omittable<StoredBetweenDays> between_days;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, reasons, campaign, synthetic, report, settings, class_limits,
                  states, trends, records, confusion, accuracy, accuracy_ci95, methods,
                  smallest_leak_l_per_min, between_days, warnings, provenance)
};

}  // namespace rigcal::report
