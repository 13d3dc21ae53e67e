#pragma once

#include <string_view>
#include <vector>

#include "metrics/agreement.hpp"
#include "report/document/document.hpp"

namespace rigcal::report {

/// Returns a column for each metric in metrics/metric_table.hpp.
std::vector<doc::Column> score_columns();

/// Returns the scores of a channel in these columns, each with its expanded uncertainty below it.
///
/// @param uncertainty  uncertainty of each score; null if unknown
/// @param unit         SI unit of the channel
std::vector<doc::Cell> score_cells(const metrics::Agreement& scores,
                                   const metrics::Agreement* uncertainty, std::string_view unit);

}  // namespace rigcal::report
