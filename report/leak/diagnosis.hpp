#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_diagnosis.hpp"

namespace rigcal::report {

/// Builds the contents of diagnosis.json.
///
/// @param reasons  why the diagnosis was declined; empty if it was not
StoredDiagnosis stored(const datasets::Campaign& campaign, const diagnosis::Diagnosis& found,
                       const std::vector<std::string>& reasons, const Provenance& provenance);

/// Writes diagnosis.csv with one row per record.
std::string diagnosis_csv(const StoredDiagnosis& diagnosis);

}  // namespace rigcal::report
