#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// Files that write_result() may write for a campaign, for HeldFolder::plan() before the work.
PlannedFiles planned_result(ResultKind kind, const datasets::Campaign& campaign);

struct WrittenResult {
  std::vector<std::filesystem::path> files;  ///< relative to the folder; the result is the last
  std::vector<doc::Document> documents;      ///< the results as the page shows them
  std::string json;                          ///< text of the last file
};

/// Writes the files of a fit or validation. Removes the leftovers of an earlier run: fitted.toml,
/// and residuals of conditions that no longer exist.
///
/// @param threads  that make the texts and draw the page
/// @throws WriteError, UsageError  as write_results()
WrittenResult write_result(HeldFolder& held, int threads, const Result& result);

/// The same files in memory, without the page; the result comes last.
std::vector<ResultFile> result_files(const Result& result, int threads);

/// A fit or validation as its page shows it.
doc::Document document_of(const Result& result);

/// The brief page of a fit or validation (report/page/page.hpp).
std::string brief_page(const Result& result);

}  // namespace rigcal::report
