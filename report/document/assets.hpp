#pragma once

#include <string_view>

namespace rigcal::report {

/// Returns a built-in file from report/page/ or from the plot library.
///
/// @throws std::out_of_range  if no built-in file has this name
std::string_view asset(std::string_view name);

}  // namespace rigcal::report
