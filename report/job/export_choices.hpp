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

/// A rig that is ready to be written, and the files that it was made from.
struct ExportChoice {
  FmuRequest fmu;
  std::vector<InputFile> inputs;
  std::vector<std::string> warnings;
};

/// The rig of a campaign with the values of the chosen condition or leak level: those of the fit
/// replace the campaign's, those of --set replace both.
///
/// @throws UsageError, InputError  the leak level is not determined; a value is missing; the rig
///                     has a term that an FMU cannot have
ExportChoice choose_export(const datasets::Campaign& campaign, const CampaignChoice& choice,
                           const ExportRequest& request);

}  // namespace rigcal::report
