#pragma once

#include <string_view>

#include "metrics/agreement.hpp"
#include "report/page/page_parts.hpp"

// The columns of a table of scores: one for each row of metrics/metric_table.hpp.

namespace rigcal::report {

/// Their titles.
Json score_titles();
/// What stands in them for one channel.
///
/// @param uncertainty  expanded, of each; null: not known
/// @param unit         of the channel, SI
Json score_cells(const metrics::Agreement& scores, const metrics::Agreement* uncertainty,
                 std::string_view unit);

}  // namespace rigcal::report
