#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page/section.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Draws, for each output channel of a condition, the mean with the standard deviation of the
/// repeats, and that standard deviation over time.
std::vector<Figure> average_figures(const std::string& condition, const Table& series);
/// Draws the figures of every condition.
std::vector<Figure> average_figures(const AverageFiles& stored);
/// Plots the delay of each repeat relative to the mean; no traces for a single repeat.
Plot offset_plot(const StoredRecord& record);

/// Functions for average.json, which shows how well the repeats of each condition agree.
doc::Verdict average_headline(const AverageFiles& stored);
std::vector<doc::Section> average_sections(const AverageFiles& stored);

}  // namespace rigcal::report
