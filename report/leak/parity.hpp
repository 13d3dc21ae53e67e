#pragma once

#include <string>
#include <vector>

#include "diagnosis/parity/parity.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored/stored_parity.hpp"

namespace rigcal::report {

/// Builds the contents of parity.json.
///
/// @param reasons      why the check was declined; empty if it was not
/// @param false_alarm  specified false-alarm probability
StoredParity stored(const datasets::Campaign& campaign, const diagnosis::Parity& parity,
                    const std::vector<std::string>& reasons, double false_alarm,
                    const Provenance& provenance);

/// Writes parity.csv with one row per record.
std::string parity_csv(const StoredParity& parity);

/// Writes parity/<condition>.csv with time_s, the position of the healthy model and, for each
/// repeat, the parity residual, the residual minus that of healthy records, and its moving root
/// mean square. Samples outside the windows have empty fields.
std::vector<ResultFile> parity_series(const diagnosis::Parity& parity);

/// Lists the files that a parity check and its page may write.
PlannedFiles planned_parity(const datasets::Campaign& campaign);

}  // namespace rigcal::report
