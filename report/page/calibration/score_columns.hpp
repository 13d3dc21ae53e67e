#pragma once

#include <string_view>
#include <vector>

#include "metrics/agreement.hpp"
#include "report/document/document.hpp"

namespace rigcal::report {

/// A column for each metric of metrics/metric_table.hpp.
std::vector<doc::Column> score_columns();

/// The scores of a channel in these columns, each with its expanded uncertainty below.
///
/// @param uncertainty  of each score; null if it is not known
/// @param unit         SI unit of the channel
std::vector<doc::Cell> score_cells(const metrics::Agreement& scores,
                                   const metrics::Agreement* uncertainty, std::string_view unit);

}  // namespace rigcal::report
