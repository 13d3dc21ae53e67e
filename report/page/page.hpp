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
  std::string file;  ///< the result itself: "fit.json"
  doc::Document document;
};

/// A drawn page, and the results on it.
struct ResultPage {
  std::string html;
  std::vector<ResultDocument> documents;
};

/// report.html of a result folder: every result in it, from its files alone. The same files give
/// the same bytes. A result that cannot be read is named on the page and left out, unless it is the
/// only one.
///
/// @param where    the folder, named in errors
/// @param made     as of load_calibration()
/// @throws InputError  there is no result, or none that this version can read
ResultPage result_page(const ReadFile& read, const std::string& where, int threads,
                       const ReadTable& made = {});

/// The same results without a page, and without curves of single conditions.
std::vector<ResultDocument> result_documents(const ReadFile& read, const std::string& where,
                                             const ReadTable& made = {});

/// The same without scripts, and without what makes it long: folds, the articles of single
/// conditions, provenance and formulas. For a notebook.
std::string brief_page(const ReadFile& read, const std::string& where, const ReadTable& made = {});

/// Every picture as a separate file in figures/, as SVG and as PDF: <condition>_<plot>, leak_table,
/// leak_levels, diagnosis, comparison_<parameter>, trend_<along>_<level>.
///
/// @throws InputError  a file is missing, or not in the format of this version
std::vector<std::pair<std::filesystem::path, std::string>> result_figures(const ReadFile& read,
                                                                          const std::string& where);

}  // namespace rigcal::report
