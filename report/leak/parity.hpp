#pragma once

#include <string>
#include <vector>

#include "diagnosis/parity.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored/stored_parity.hpp"

namespace rigcal::report {

/// Parity residuals with all that their files are made from. Borrows everything.
struct ParityResult {
  const datasets::Campaign& campaign;
  const diagnosis::Parity& parity;
  const std::vector<std::string>& reasons;  ///< why it was declined; empty if it was not
  double false_alarm = 0.0;                 ///< stated probability for a healthy record
  const Provenance& provenance;
};

/// Declined where it gives reasons; failed where no residual could be made.
LeakStatus status_of(const ParityResult& result);

/// parity.json.
StoredParity stored(const ParityResult& result);

/// parity.csv: one row per record.
std::string parity_csv(const ParityResult& result);

/// parity/<condition>.csv: time_s, the healthy model's position, and for each repeat the parity
/// residual, the residual minus that of healthy records, and its moving root mean square. Fields of
/// samples outside the windows are empty.
std::vector<ResultFile> parity_series(const ParityResult& result);

/// Files that parity and its page may write.
PlannedFiles planned_parity(const datasets::Campaign& campaign);

}  // namespace rigcal::report
