#pragma once

#include <string>
#include <vector>

#include "report/fmu/fmu.hpp"

namespace rigcal::report {

/// Packs files into a ZIP archive. The same files always give the same bytes, because all entries
/// have the same time stamp.
///
/// @throws WriteError  if libzip fails, with the message from libzip
std::string zipped(const std::vector<FmuFile>& files);

}  // namespace rigcal::report
