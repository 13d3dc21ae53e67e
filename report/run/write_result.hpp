#pragma once

#include <filesystem>
#include <vector>

#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/result.hpp"

namespace rigcal::report {

/// Writes the files of a fit or validation. A failed fit takes the fitted.toml of an earlier one
/// away.
///
/// @param threads  that draw the page
/// @param json     result_json() of the result, to which the names of its files are added
/// @return         what was written
/// @throws WriteError, UsageError  as write_results()
std::vector<ResultFile> write_result(const std::filesystem::path& out, int threads,
                                     const Result& result, Json& json);

}  // namespace rigcal::report
