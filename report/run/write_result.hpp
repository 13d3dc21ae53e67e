#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// Lists the files that write_result() may write for a campaign, for HeldFolder::plan() before the
/// computation.
PlannedFiles planned_result(ResultKind kind, const datasets::Campaign& campaign);

struct WrittenResult {
  std::vector<std::filesystem::path> files;  ///< relative to the folder; the result file is last
  std::vector<doc::Document> documents;      ///< the results as the page shows them
  std::string json;                          ///< text of the last file, or what is printed
};

/// Writes the files of a fit or validation. Removes files left by an earlier run that no longer
/// apply: fitted.toml, and residuals of conditions that no longer exist.
///
/// @param threads  number of threads for creating the texts and drawing the page
/// @throws WriteError, UsageError  as for write_results()
WrittenResult write_result(HeldFolder& held, int threads, const Result& result);

/// Creates the files of a fit or validation in memory, without the page. The result file is last.
std::vector<ResultFile> result_files(const Result& result, int threads);

/// Returns a fit or validation in the form in which its page shows it.
doc::Document document_of(const Result& result);

/// Returns the brief page of a fit or validation (report/page/page.hpp).
std::string brief_page(const Result& result);

}  // namespace rigcal::report
