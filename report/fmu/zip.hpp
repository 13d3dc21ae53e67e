#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"

namespace rigcal::report {

/// A ZIP archive of files. The same files give the same bytes, since it has no time stamps.
///
/// @throws WriteError  libzip fails (in its words)
std::string zipped(const std::vector<FmuFile>& files);

}  // namespace rigcal::report
