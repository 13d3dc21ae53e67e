#pragma once

#include <vector>

#include "report/page/section.hpp"

namespace rigcal::report {

/// Returns the part of the page for fit.json or validation.json: a fit or validation, or a fit to
/// published tables.
Part calibration_part(const ResultFolder& folder);
std::vector<Figure> calibration_figures(const ResultFolder& folder);

}  // namespace rigcal::report
