#pragma once

#include <string>
#include <vector>

#include "report/store/folder.hpp"
#include "report/store/stored.hpp"

// The files from one run belong together. The JSON result lists the others with their SHA-256, so
// that readers can refuse files from another run.

namespace rigcal::report {

/// Fills `provenance.files` with the path and SHA-256 of each of `files`, in order, and also stores
/// the hashes in `files`.
void name_files(std::vector<ResultFile>& files, StoredProvenance& provenance);
/// @param named  files that are already written; they come first in `provenance.files`
void name_files(std::vector<InputFile> named, std::vector<ResultFile>& files,
                StoredProvenance& provenance);

/// Returns a reader that accepts only files from the same run as the result.
///
/// @param read  reads from the folder; borrowed
/// @param provenance  provenance of the result; if an older version wrote it, it lists no files,
///                    and the reader accepts any file
/// @param where  the folder, for messages
/// @param file  name of the result, for messages
/// @return  reader that throws InputError if the hash of a file is not the listed one
ReadFile files_of_run(const ReadFile& read, const StoredProvenance& provenance,
                      const std::string& where, const std::string& file);

}  // namespace rigcal::report
