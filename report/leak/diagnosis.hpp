#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/leak/read_leak_table.hpp"
#include "report/store/json.hpp"
#include "report/store/stored_provenance.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

inline constexpr const char* kDiagnosisSchema = "rigcal.diagnosis/1";

/// A diagnosis with all that its files are made from. Borrows everything.
struct DiagnosisResult {
  const datasets::Campaign& campaign;
  const diagnosis::Diagnosis& diagnosis;
  const std::vector<std::string>& reasons;  ///< why it was declined; empty if it was not
  const Provenance& provenance;
  /// Of the leak table that gave the limits of the classes; empty where [diagnosis] did.
  std::vector<TableLimit> class_limits = {};
};

/// "done"; "declined" where it gives reasons; "failed" where no record could be diagnosed.
std::string status_of(const DiagnosisResult& result);

/// diagnosis.json as docs/diagnosis.md describes it; `status` comes first.
Json diagnosis_json(const DiagnosisResult& result);

/// diagnosis.csv: one row per record.
std::string diagnosis_csv(const DiagnosisResult& result);

/// The averages, how often each method is right, the smallest leaks, warnings.
std::string diagnosis_text(const DiagnosisResult& result, const Style& style);

}  // namespace rigcal::report
