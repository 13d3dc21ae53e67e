#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// Functions for `design` in plan.json: the test that `plan --design` designed.
doc::Verdict design_headline(const StoredDesign& design);
/// @param files  must contain a design
doc::Section design_section(const PlanFiles& files);
/// Draws the drive, the response and the spectrum; empty without a design.
std::vector<Figure> design_figures(const PlanFiles& files);

}  // namespace rigcal::report
