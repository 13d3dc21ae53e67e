#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/store/result.hpp"
#include "report/store/stored.hpp"

// The calibrated rig from a fit, a validation or a diagnosis, for the live section of its page.

namespace rigcal::report {

/// File name for a fit or validation. The other kinds of results have different names with the same
/// ending, because one folder may contain several kinds.
inline constexpr const char* kLiveFile = "live.json";
inline constexpr const char* kLiveDiagnosisFile = "diagnosis_live.json";
inline constexpr const char* kLiveLeakTableFile = "leak_table_live.json";

/// Builds the contents of live.json: the rig with its estimates, and the conditions with their
/// measured means, in the order of calib::shown_before(). Returns std::nullopt if no condition was
/// scored or the search did not converge.
std::optional<Json> live_fit(const Result& result);

/// Builds the contents of diagnosis_live.json: the healthy rig with the leak found in each averaged
/// record, largest leak first. Returns std::nullopt if no leak could be determined.
///
/// @param averages  the diagnosed records
/// @param healthy   estimates from the fit that the diagnosis is based on
std::optional<Json> live_diagnosis(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& averages,
                                   const std::vector<datasets::FittedValue>& healthy,
                                   const diagnosis::Diagnosis& found);

/// The section of a page that contains the simulated rig, and the scripts that run it.
struct LiveSection {
  std::string html;
  std::string scripts;
};

/// Builds the live section. Returns std::nullopt if this program was built without the model for
/// pages.
///
/// @param rig  contents of live.json
std::optional<LiveSection> live_section(const Json& rig);

}  // namespace rigcal::report
