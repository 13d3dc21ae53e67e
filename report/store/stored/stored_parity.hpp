#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/parity.hpp"
#include "report/store/stored/stored_leak.hpp"
#include "report/store/stored/stored_provenance.hpp"

// parity.json (docs/parity.md).

namespace rigcal::report {

inline constexpr const char* kParitySchema = "rigcal.parity/1";

struct StoredParityRecord {
  std::string condition;
  std::optional<int> repeat;  ///< from 1; absent for an averaged file
  std::string signal;
  std::optional<std::string> leak_level;
  bool healthy = false;
  bool sets_threshold = false;
  int reference_records = 0;
  std::optional<std::string> failure;
  std::optional<double> peak_m;
  std::optional<bool> alarm;  ///< absent if not judged
  std::optional<double> time_to_alarm_s;
  metrics::ByFeature<std::optional<double>> features;
  metrics::ByFeature<std::optional<bool>> exceeds;  ///< absent without a threshold
  Omittable<double> threshold_m;                    ///< threshold for records from that day
  RIGCAL_DESCRIBE(condition, repeat, signal, leak_level, healthy, sets_threshold, reference_records,
                  failure, peak_m, alarm, time_to_alarm_s, features, exceeds, threshold_m)
};

struct StoredParity {
  LeakStatus status = LeakStatus::failed;
  std::string schema = kParitySchema;
  std::vector<std::string> reasons;  ///< why it was declined
  std::string campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  double false_alarm_probability = 0.0;
  std::vector<diagnosis::ParitySignal> signals;
  std::vector<StoredParityRecord> records;
  diagnosis::FalseAlarmCheck false_alarm_check;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, reasons, campaign, synthetic, report, false_alarm_probability,
                  signals, records, false_alarm_check, warnings, provenance)
};

}  // namespace rigcal::report
