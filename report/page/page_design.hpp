#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// `design` of plan.json: the test of `plan --design`.
doc::Verdict design_headline(const StoredDesign& design);
/// @param files  with a design
doc::Section design_section(const PlanFiles& files);
/// Drive, response and spectrum; none without a design.
std::vector<Figure> design_figures(const PlanFiles& files);

}  // namespace rigcal::report
