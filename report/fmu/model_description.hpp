#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"
#include "report/fmu/variables.hpp"

namespace rigcal::report {

/// Writes modelDescription.xml according to FMI 2.0.
///
/// @param sources  names of the files to compile, relative to sources/
std::string model_description(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              std::size_t indicators, const std::vector<std::string>& sources);

}  // namespace rigcal::report
