#pragma once

#include <vector>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

/// plan.json: what each record tells, or would tell, of each parameter.
Json plan_headline(const Json& plan);
Json plan_view(const Json& plan);
/// Per parameter: how much of the precision (one over the variance) of all records together each
/// has by itself.
std::vector<Figure> plan_figures(const Json& plan);

}  // namespace rigcal::report
