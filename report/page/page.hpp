#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// Draws report.html for a result folder. The page shows every result in the folder and is made
/// only from its files. The same files always give the same bytes. A result that cannot be read is
/// named on the page and left out, unless it is the only one.
///
/// @param where  the folder, for error messages
/// @throws InputError  if there is no result that this version can read
std::string result_page(const ReadFile& read, const std::string& where, int threads);

/// Inserts report.html before the last of `files`, which is the JSON file that marks the result as
/// complete. The page shows these files and other results that already exist in `out`, as `report`
/// would.
///
/// @param made  finds files of this run that are not among `files`
/// @return      the results among `files`
std::vector<doc::Document> add_page(const std::filesystem::path& out, int threads,
                                    std::vector<ResultFile>& files, const ReadFile& made = {});

/// Returns the results in a folder without drawing a page or the curves of single conditions.
std::vector<doc::Document> result_documents(const ReadFile& read, const std::string& where);

/// Draws a short page for a notebook, without scripts, collapsible sections, articles on individual
/// conditions, provenance or formulas.
std::string brief_page(const ReadFile& read, const std::string& where);

/// Returns every picture as a separate file in figures/, as SVG and as PDF: <condition>_<plot>,
/// leak_table, leak_levels, diagnosis, comparison_<parameter>, trend_<along>_<level>.
///
/// @throws InputError  if a file is missing or does not have the format of this version
std::vector<std::pair<std::filesystem::path, std::string>> result_figures(const ReadFile& read,
                                                                          const std::string& where);

}  // namespace rigcal::report
