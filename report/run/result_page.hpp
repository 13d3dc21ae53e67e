#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// Reads from files in memory, which must outlive it.
ReadFile files_in(const std::vector<ResultFile>& files);

/// Adds report.html before the last of `files`, the JSON that marks the result as complete. The
/// page shows these files and other results that are already in `out`, as `report` would.
///
/// @param made  the tables of this run's residuals/, if they are not among `files`
/// @return      the results among `files`
std::vector<doc::Document> add_page(const std::filesystem::path& out, int threads,
                                    std::vector<ResultFile>& files, const ReadTable& made = {});

/// The results among files in memory.
///
/// @param where  for messages
std::vector<doc::Document> documents_in(const std::vector<ResultFile>& files,
                                        const std::string& where, const ReadTable& made = {});

}  // namespace rigcal::report
