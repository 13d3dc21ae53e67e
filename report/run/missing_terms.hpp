#pragma once

#include <string>
#include <vector>

#include "calib/result/considered.hpp"

namespace rigcal::report {

/// A term that the model lacks, in the form of a line for a campaign file.
struct MissingTerm {
  bool of_controller = false;  ///< belongs in [rig.controller]; otherwise [rig.parameters]
  std::string line;            ///< "valve_time_constant = { start = ..., fit = true }"
};

/// Lines of campaign files that estimate the terms that the residuals of a fit ask for, from their
/// sizes. What no parameter describes has none.
std::vector<MissingTerm> missing_terms(model::PlantKind plant, const calib::Considered& considered);

/// Inserts the lines for missing terms at the beginning of their tables in the text of a campaign
/// file.
std::string with_terms(std::string campaign, const std::vector<MissingTerm>& terms);

}  // namespace rigcal::report
