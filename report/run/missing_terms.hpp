#pragma once

#include <string>
#include <vector>

#include "calib/result/considered.hpp"

namespace rigcal::report {

/// A term that the model lacks, as a line for a campaign file.
struct MissingTerm {
  bool of_controller = false;  ///< belongs in [rig.controller]; otherwise [rig.parameters]
  std::string line;            ///< "valve_time_constant = { start = ..., fit = true }"
};

/// Makes lines for a campaign file that estimate the terms which the residuals of a fit call for.
/// The start values follow from the sizes of the effects. Effects that no parameter describes are
/// skipped.
std::vector<MissingTerm> missing_terms(model::PlantKind plant, const calib::Considered& considered);

/// Inserts the lines for missing terms at the beginning of their tables in the text of a campaign
/// file.
std::string with_terms(std::string campaign, const std::vector<MissingTerm>& terms);

}  // namespace rigcal::report
