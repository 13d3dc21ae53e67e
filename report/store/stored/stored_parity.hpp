#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/parity/parity.hpp"
#include "report/store/stored/leak_status.hpp"
#include "report/store/stored/stored_provenance.hpp"

// parity.json (docs/parity.md).

namespace rigcal::report {

inline constexpr const char* kParitySchema = "rigcal.parity/1";

struct StoredParity {
  LeakStatus status = LeakStatus::failed;
  std::string schema = kParitySchema;
  std::vector<std::string> reasons;  ///< why it was declined
  std::string campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  double false_alarm_probability = 0.0;
  std::vector<diagnosis::ParitySignal> signals;
  std::vector<diagnosis::ParityRecord> records;
  diagnosis::FalseAlarmCheck false_alarm_check;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, reasons, campaign, synthetic, report, false_alarm_probability,
                  signals, records, false_alarm_check, warnings, provenance)
};

}  // namespace rigcal::report
