#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"
#include "report/job/job.hpp"

namespace rigcal::report {

struct ExportRequest {
  FitSource fit;
  std::optional<std::string> condition;
  std::optional<std::string> level;
  bool without_delay = false;
};

/// A rig that is ready for export, and the files that it was made from.
struct ExportChoice {
  FmuRequest fmu;
  std::vector<InputFile> inputs;
  std::vector<std::string> warnings;
};

/// Returns the rig of a campaign with the values for the chosen condition or leak level. Values
/// from the fit override those of the campaign, and values from --set override both.
///
/// @throws UsageError, InputError  if the leak level is ambiguous, a value is missing, or the rig
///                                 has a term that an FMU cannot represent
ExportChoice choose_export(const datasets::Campaign& campaign, const CampaignChoice& choice,
                           const ExportRequest& request);

}  // namespace rigcal::report
