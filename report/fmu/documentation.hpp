#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"
#include "report/fmu/variables.hpp"

namespace rigcal::report {

/// Writes documentation/index.html: where the values come from, the variables, and how to compile
/// the sources.
///
/// @param compile  the command that compiles the sources
std::string fmu_documentation(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              const std::string& compile);

}  // namespace rigcal::report
