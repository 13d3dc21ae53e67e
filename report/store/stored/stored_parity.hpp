#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/store/stored/stored_leak.hpp"
#include "report/store/stored/stored_provenance.hpp"

// parity.json, as docs/parity.md describes it.

namespace rigcal::report {

inline constexpr const char* kParitySchema = "rigcal.parity/1";

/// Thresholds from the healthy records of one signal.
struct StoredParitySignal {
  std::string signal;
  std::optional<double> window_s;
  int healthy_records = 0;
  std::optional<double> threshold_m;
  ByFeature<std::optional<double>> feature_thresholds;
  std::optional<std::string> reason;  ///< why there is no threshold
  /// The record is of a day that the healthy records do not have.
  Omittable<double> threshold_of_another_day_m;
  Omittable<int> common_causes;  ///< by which the healthy records differ beyond noise
  RIGCAL_DESCRIBE(signal, window_s, healthy_records, threshold_m, feature_thresholds, reason,
                  threshold_of_another_day_m, common_causes)
};

struct StoredParityRecord {
  std::string condition;
  std::optional<int> repeat;  ///< from 1; nothing: an averaged file
  std::string signal;
  std::optional<std::string> leak_level;
  bool healthy = false;
  bool sets_threshold = false;
  int reference_records = 0;
  std::optional<std::string> failure;
  std::optional<double> peak_m;
  std::optional<bool> alarm;  ///< nothing: not judged
  std::optional<double> time_to_alarm_s;
  ByFeature<std::optional<double>> features;
  ByFeature<std::optional<bool>> exceeds;  ///< nothing: no threshold
  Omittable<double> threshold_m;           ///< threshold for records of its day
  RIGCAL_DESCRIBE(condition, repeat, signal, leak_level, healthy, sets_threshold, reference_records,
                  failure, peak_m, alarm, time_to_alarm_s, features, exceeds, threshold_m)
};

struct StoredFalseAlarmCheck {
  int records = 0, alarms = 0;
  std::optional<double> expected, p_value;
  RIGCAL_DESCRIBE(records, alarms, expected, p_value)
};

struct StoredParity {
  LeakStatus status = LeakStatus::failed;
  std::string schema = kParitySchema;
  std::vector<std::string> reasons;  ///< why it was declined
  std::string campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  double false_alarm_probability = 0.0;
  std::vector<StoredParitySignal> signals;
  std::vector<StoredParityRecord> records;
  StoredFalseAlarmCheck false_alarm_check;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, reasons, campaign, synthetic, report, false_alarm_probability,
                  signals, records, false_alarm_check, warnings, provenance)
};

}  // namespace rigcal::report
