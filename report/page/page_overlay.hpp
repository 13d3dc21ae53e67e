#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/page/section.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Draws, for each channel in overlay/<condition>.csv, the measurement with the models of all
/// results, and the residual of each result.
///
/// @param names  names of the results, in the order of their numbers
std::vector<Figure> overlay_figures(const std::string& condition, const Table& curves,
                                    const std::vector<std::string>& names);

/// A comparison with its overlaid curves for each condition, in the order of the scores.
struct ComparisonFiles {
  StoredComparison result;
  std::vector<std::pair<std::string, Table>> curves;
};
ComparisonFiles load_comparison_files(const ReadFile& read, const std::string& where);
doc::Verdict comparison_headline(const ComparisonFiles& files);
std::vector<doc::Section> comparison_sections(const ComparisonFiles& files);
std::vector<Figure> comparison_figures(const ComparisonFiles& files);
/// Adds a comparison. It names the campaigns of the compared results.
void add_comparison(const ComparisonFiles& files, Part& part);

}  // namespace rigcal::report
