#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page/section.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Per output channel of a condition: the mean with the standard deviation of its repeats, and that
/// standard deviation over time.
std::vector<Figure> average_figures(const std::string& condition, const Table& series);
/// Figures of every condition.
std::vector<Figure> average_figures(const AverageFiles& stored);
/// Delay of each repeat against their mean; no traces for a single repeat.
Plot offset_plot(const StoredRecord& record);

/// average.json: how the repeats of every condition agree.
doc::Verdict average_headline(const AverageFiles& stored);
std::vector<doc::Section> average_sections(const AverageFiles& stored);

}  // namespace rigcal::report
