#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page/page_parts.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// average.json: how the repeats of every condition agree.
struct AverageFiles {
  Json average;
  std::vector<Table> series;  ///< averaged/<condition>.csv, shape (records); empty where missing
};
AverageFiles load_average(const ReadFile& read, const std::string& where);

/// Per output channel of a condition: the mean with the standard deviation of its repeats, and that
/// standard deviation over time.
std::vector<Figure> average_figures(const std::string& condition, const Table& series);
/// By how much each repeat came later than their mean; no traces where there is but one.
Plot offset_plot(const Json& record);

Json average_headline(const Json& average);
Json average_view(const AverageFiles& stored);

}  // namespace rigcal::report
