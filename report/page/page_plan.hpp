#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// plan.json: information of each record, existing or planned, about each parameter.
/// With `plan --design` also the test that was designed.
doc::Verdict plan_headline(const PlanFiles& files);
std::vector<doc::Section> plan_sections(const PlanFiles& files);
/// For each parameter the fraction of the total information (1 / variance) that each record alone
/// provides; then those of the design.
std::vector<Figure> plan_figures(const PlanFiles& files);

}  // namespace rigcal::report
