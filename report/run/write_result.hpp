#pragma once

#include <filesystem>
#include <vector>

#include "report/store/folder.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// Files that write_result() may write for a campaign, for HeldFolder::plan() before the work.
PlannedFiles planned_result(ResultKind kind, const datasets::Campaign& campaign);

/// Writes the files of a fit or validation. Removes the leftovers of an earlier run: fitted.toml,
/// and residuals of conditions that no longer exist.
///
/// @param threads  that make the texts and draw the page
/// @param stored   stored() of the result, to which the names of its files are added
/// @return         what was written, relative to `out`; the page and the result come last
/// @throws WriteError, UsageError  as write_results()
std::vector<std::filesystem::path> write_result(HeldFolder& held, int threads, const Result& result,
                                                StoredFit& stored);

/// The same files in memory, without the page; the result comes last.
std::vector<ResultFile> result_files(const Result& result, int threads);

/// The brief page of a fit or validation (report/page/page.hpp).
std::string brief_page(const Result& result);

}  // namespace rigcal::report
