#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// plan.json: what each record tells, or would tell, of each parameter.
doc::Verdict plan_headline(const StoredPlan& plan);
std::vector<doc::Section> plan_sections(const StoredPlan& plan);
/// Per parameter: how much of the precision (one over the variance) of all records together each
/// has by itself.
std::vector<Figure> plan_figures(const StoredPlan& plan);

}  // namespace rigcal::report
