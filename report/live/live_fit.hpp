#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "report/store/result.hpp"
#include "report/store/stored.hpp"

// The calibrated rig of a fit, a validation or a diagnosis, for the live section of its page.

namespace rigcal::report {

/// File of a fit or validation. Results of several kinds may be in one folder, so others have names
/// of their own, which end alike.
inline constexpr const char* kLiveFile = "live.json";
inline constexpr const char* kLiveDiagnosisFile = "diagnosis_live.json";
inline constexpr const char* kLiveLeakTableFile = "leak_table_live.json";

/// Contents of live.json: the rig with the estimates, and conditions with their measured means,
/// validation conditions and worst ones first. Nothing if no condition was scored, or if the search
/// did not converge.
std::optional<Json> live_fit(const Result& result);

/// Contents of diagnosis_live.json: the healthy rig with the leak that was found in each average,
/// the largest first. Nothing if no leak was found out.
///
/// @param averages  the records that were diagnosed
/// @param healthy   estimates of the fit that the diagnosis rests on
std::optional<Json> live_diagnosis(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& averages,
                                   const std::vector<datasets::FittedValue>& healthy,
                                   const diagnosis::Diagnosis& found);

/// The section of a page with the rig in it, and the scripts that run it.
struct LiveSection {
  std::string html;
  std::string scripts;
};

/// Nothing if this program was built without the model for pages.
///
/// @param text  live.json
/// @throws InputError  it is no JSON
std::optional<LiveSection> live_section(const std::string& text, const std::string& where);

}  // namespace rigcal::report
