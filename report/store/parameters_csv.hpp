#pragma once

#include <string>

#include "report/store/json.hpp"

namespace rigcal::report {

/// parameters.csv of a fit.json or validation.json: one row per parameter, in `unit`. As the other
/// tables of csv.hpp.
std::string parameters_csv(const Json& result);

}  // namespace rigcal::report
