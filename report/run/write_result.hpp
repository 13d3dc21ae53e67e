#pragma once

#include <filesystem>
#include <vector>

#include "report/store/folder.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// Writes the files of a fit or validation. A failed fit takes the fitted.toml of an earlier one
/// away.
///
/// @param threads  that make the texts and draw the page
/// @param stored   stored() of the result, to which the names of its files are added
/// @return         what was written, relative to `out`; the page and the result come last
/// @throws WriteError, UsageError  as write_results()
std::vector<std::filesystem::path> write_result(const std::filesystem::path& out, int threads,
                                                const Result& result, StoredFit& stored);

}  // namespace rigcal::report
