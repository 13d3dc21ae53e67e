#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/leak/read_leak_table.hpp"
#include "report/store/stored/stored_diagnosis.hpp"

namespace rigcal::report {

/// A diagnosis with all that its files are made from. Borrows everything.
struct DiagnosisResult {
  const datasets::Campaign& campaign;
  const diagnosis::Diagnosis& diagnosis;
  const std::vector<std::string>& reasons;  ///< why it was declined; empty if it was not
  const Provenance& provenance;
  /// Limits of the leak table that gave the classes; empty if [diagnosis] gave them.
  std::vector<TableLimit> class_limits = {};
};

/// Declined where it gives reasons; failed where no record could be diagnosed.
LeakStatus status_of(const DiagnosisResult& result);

/// "sine 0.1 Hz, 50.8 mm": the signal of an entry of the leak table.
std::string drive_of(const datasets::Campaign& campaign, const TableLimit& limit);

/// diagnosis.json.
StoredDiagnosis stored(const DiagnosisResult& result);

/// diagnosis.csv: one row per record.
std::string diagnosis_csv(const DiagnosisResult& result);

}  // namespace rigcal::report
