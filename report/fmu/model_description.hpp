#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"
#include "report/fmu/variables.hpp"

namespace rigcal::report {

/// modelDescription.xml of FMI 2.0.
///
/// @param sources  names of the files to compile, in the folder sources/
std::string model_description(const FmuRequest& request, const std::vector<FmuVariable>& variables,
                              std::size_t indicators, const std::vector<std::string>& sources);

}  // namespace rigcal::report
