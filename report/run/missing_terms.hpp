#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/plant/parameter.hpp"

namespace rigcal::report {

/// A term that the model lacks, in the form of a line for a campaign file.
struct MissingTerm {
  bool of_controller = false;  ///< belongs in [rig.controller]; otherwise [rig.parameters]
  std::string line;            ///< "valve_time_constant = { start = ..., fit = true }"
};

/// Writes lines for a campaign file that estimate the terms suggested by the residuals, starting at
/// the suggested sizes. An effect that no parameter describes gets no line.
///
/// @param sizes  size of each effect by its key, SI
std::vector<MissingTerm> missing_terms(model::PlantKind plant,
                                       const std::vector<std::pair<std::string, double>>& sizes);

/// Inserts the lines for missing terms at the beginning of their tables in the text of a campaign
/// file.
std::string with_terms(std::string campaign, const std::vector<MissingTerm>& terms);

}  // namespace rigcal::report
