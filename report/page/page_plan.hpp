#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// Functions for plan.json: how much information each existing or planned record gives about each
/// parameter. With `plan --design` it also contains the designed test.
doc::Verdict plan_headline(const PlanFiles& files);
std::vector<doc::Section> plan_sections(const PlanFiles& files);
/// Plots, for each parameter, the fraction of the total information (1 / variance) that each record
/// provides on its own, followed by the figures of the design.
std::vector<Figure> plan_figures(const PlanFiles& files);

}  // namespace rigcal::report
