#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/store/stored/leak_status.hpp"
#include "report/store/stored/stored_provenance.hpp"

// diagnosis.json (docs/diagnosis.md).

namespace rigcal::report {

inline constexpr const char* kDiagnosisSchema = "rigcal.diagnosis/1";

struct StoredDiagnosis {
  LeakStatus status = LeakStatus::failed;
  std::string schema = kDiagnosisSchema;
  std::vector<std::string> reasons;  ///< why it was declined
  std::string campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  Inlined<diagnosis::Diagnosis> found;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, reasons, campaign, synthetic, report, found, provenance)
};

}  // namespace rigcal::report
