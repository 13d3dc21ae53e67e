#pragma once

#include <string>
#include <vector>

#include "calib/result/considered.hpp"

namespace rigcal::report {

/// A term that a model lacks, as a campaign may have it.
struct MissingTerm {
  bool of_controller = false;  ///< its place is [rig.controller], else [rig.parameters]
  std::string line;            ///< "valve_time_constant = { start = ..., fit = true }"
};

/// Lines of campaign files that estimate the terms that the residuals of a fit ask for, from their
/// sizes. What no parameter describes has none.
std::vector<MissingTerm> missing_terms(model::PlantKind plant, const calib::Considered& considered);

/// The text of a campaign file with these lines at the head of their tables.
std::string with_terms(std::string campaign, const std::vector<MissingTerm>& terms);

}  // namespace rigcal::report
