#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/provenance.hpp"

namespace rigcal::report {

/// A result file that is complete but not yet written.
struct ResultFile {
  std::filesystem::path path;  ///< relative to the result folder
  std::string content;
};

/// Tries whether files can be made in `out`, before any long work. Leaves no trace.
///
/// @throws WriteError  with path and reason
void require_writable(const std::filesystem::path& out);

/// Refuses a result that would replace one of the files it was made from.
///
/// @throws UsageError  naming the file
void require_inputs_kept(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& results,
                         const std::vector<InputFile>& inputs);

/// Writes every file, each whole or not at all.
///
/// @throws WriteError  with path and reason
/// @throws UsageError  a file would replace one of `inputs`; then none is written
void write_results(const std::filesystem::path& out, const std::vector<ResultFile>& files,
                   const std::vector<InputFile>& inputs);

/// Removes a file of an earlier run that would contradict this one.
///
/// @throws WriteError  it is there and cannot be removed
void remove_stale(const std::filesystem::path& file);

}  // namespace rigcal::report
