#pragma once

#include <string_view>

namespace rigcal::report {

/// A file of report/page/ or of the plot library, as it was built in.
///
/// @throws std::out_of_range  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace rigcal::report
