#pragma once

#include <filesystem>
#include <vector>

#include "report/store/folder.hpp"

namespace rigcal::report {

/// Adds report.html before the last of `files`, the JSON that marks the result as whole. The page
/// shows these files, and other results that lie in `out` already, as `report` would.
void add_page(const std::filesystem::path& out, int threads, std::vector<ResultFile>& files);

}  // namespace rigcal::report
