#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/leak/read_leak_table.hpp"
#include "report/store/stored/stored_diagnosis.hpp"

namespace rigcal::report {

/// A diagnosis with everything needed to write its files. Borrows all of it.
struct DiagnosisResult {
  const datasets::Campaign& campaign;
  const diagnosis::Diagnosis& diagnosis;
  const std::vector<std::string>& reasons;  ///< why the diagnosis was declined; empty if it was not
  const Provenance& provenance;
  /// Limits from the leak table that defined the classes; empty if [diagnosis] defined them.
  std::vector<calib::LeakEntry> class_limits = {};
};

/// Returns declined if there are reasons for it, and failed if no record could be diagnosed.
LeakStatus status_of(const DiagnosisResult& result);

/// Describes the signal of a drive in the leak table: "sine 0.1 Hz, 50.8 mm".
std::string drive_of(const datasets::Campaign& campaign, const calib::LeakDrive& drive);

/// Builds the contents of diagnosis.json.
StoredDiagnosis stored(const DiagnosisResult& result);

/// Writes diagnosis.csv with one row per record.
std::string diagnosis_csv(const StoredDiagnosis& diagnosis);

}  // namespace rigcal::report
