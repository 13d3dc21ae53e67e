#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// A result in a folder.
struct ResultDocument {
  std::string file;  ///< file with the result itself: "fit.json"
  doc::Document document;
};

/// A drawn page, and the results on it.
struct ResultPage {
  std::string html;
  std::vector<ResultDocument> documents;
};

/// Draws report.html for a result folder. The page shows every result in the folder and is made
/// only from its files. The same files always give the same bytes. A result that cannot be read is
/// named on the page and left out, unless it is the only one.
///
/// @param where  the folder, for error messages
/// @param made   as for load_calibration()
/// @throws InputError  if there is no result that this version can read
ResultPage result_page(const ReadFile& read, const std::string& where, int threads,
                       const ReadTable& made = {});

/// Returns the results in a folder without drawing a page or the curves of single conditions.
std::vector<ResultDocument> result_documents(const ReadFile& read, const std::string& where,
                                             const ReadTable& made = {});

/// Draws a short page for a notebook, without scripts, collapsible sections, articles on individual
/// conditions, provenance or formulas.
std::string brief_page(const ReadFile& read, const std::string& where, const ReadTable& made = {});

/// Returns every picture as a separate file in figures/, as SVG and as PDF: <condition>_<plot>,
/// leak_table, leak_levels, diagnosis, comparison_<parameter>, trend_<along>_<level>.
///
/// @throws InputError  if a file is missing or does not have the format of this version
std::vector<std::pair<std::filesystem::path, std::string>> result_figures(const ReadFile& read,
                                                                          const std::string& where);

}  // namespace rigcal::report
