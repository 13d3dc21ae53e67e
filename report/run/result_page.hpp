#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// Returns a reader for files in memory. The files must outlive the reader.
ReadFile files_in(const std::vector<ResultFile>& files);

/// Inserts report.html before the last of `files`, which is the JSON file that marks the result as
/// complete. The page shows these files and other results that already exist in `out`, as `report`
/// would.
///
/// @param made  tables for this run's residuals/, if they are not among `files`
/// @return      the results among `files`
std::vector<doc::Document> add_page(const std::filesystem::path& out, int threads,
                                    std::vector<ResultFile>& files, const ReadTable& made = {});

/// Returns the results among files in memory.
///
/// @param where  location of the files, for messages
std::vector<doc::Document> documents_in(const std::vector<ResultFile>& files,
                                        const std::string& where, const ReadTable& made = {});

}  // namespace rigcal::report
