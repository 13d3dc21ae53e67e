#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// plan.json: information of each record, existing or planned, about each parameter.
doc::Verdict plan_headline(const StoredPlan& plan);
std::vector<doc::Section> plan_sections(const StoredPlan& plan);
/// For each parameter the fraction of the total information (1 / variance) that each record alone
/// provides.
std::vector<Figure> plan_figures(const StoredPlan& plan);

}  // namespace rigcal::report
