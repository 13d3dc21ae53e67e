#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page/page_parts.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Per channel of overlay/<condition>.csv: what was measured under the models of all results, and
/// what each leaves of it.
///
/// @param names  of the results, in the order of their numbers
std::vector<Figure> overlay_figures(const std::string& condition, const Table& curves,
                                    const std::vector<std::string>& names);

/// For the template: an entry for each condition.
///
/// @param curves  by condition
Json overlays_view(const std::vector<std::pair<std::string, Table>>& curves,
                   const std::vector<std::string>& names);

}  // namespace rigcal::report
