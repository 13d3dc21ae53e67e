#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"
#include "report/fmu/variables.hpp"

namespace rigcal::report {

/// documentation/index.html: origin of the values, the variables, and how to compile the sources.
///
/// @param compile  the command
std::string fmu_documentation(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              const std::string& compile);

}  // namespace rigcal::report
