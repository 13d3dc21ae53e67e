#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rigcal::report {

/// The text of a result file by its path in the result folder; nothing where there is none.
using ReadFile = std::function<std::optional<std::string>(const std::filesystem::path&)>;

/// Reads from a folder on disk.
ReadFile files_in(const std::filesystem::path& folder);

/// report.html of a fit or validation: the whole page from fit.json or validation.json,
/// residual_tests.json and residuals/. The same files give the same bytes. Where both results lie
/// in one folder, the one to which residual_tests.json belongs.
///
/// @param where    the folder, named in errors
/// @throws InputError  a file is missing, or is not what this version writes
std::string result_page(const ReadFile& read, const std::string& where, int threads);

/// Pictures of every condition as SVG files that stand alone: figures/<condition>_<plot>.svg.
///
/// @throws InputError  as result_page()
std::vector<std::pair<std::filesystem::path, std::string>> result_figures(const ReadFile& read,
                                                                          const std::string& where);

}  // namespace rigcal::report
