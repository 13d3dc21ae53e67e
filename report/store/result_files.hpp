#pragma once

#include <string>
#include <vector>

#include "report/store/folder.hpp"
#include "report/store/stored.hpp"

// The files of one run belong together. The result in JSON lists the others with their SHA-256, and
// readers refuse files of another run in their place.

namespace rigcal::report {

/// Fills `provenance.files` with path and SHA-256 of each of `files`, in their order, and stores
/// the hashes in `files`, too.
void name_files(std::vector<ResultFile>& files, StoredProvenance& provenance);
/// @param named  of files that are written already, which come first
void name_files(std::vector<InputFile> named, std::vector<ResultFile>& files,
                StoredProvenance& provenance);

/// Reads the files of a result's own run.
///
/// @param read    the folder, borrowed
/// @param provenance  of the result; one that names no files, of an earlier version, takes any
/// @param where   the folder, for messages
/// @param file    of the result, for messages
/// @return        throws InputError where a file is not the one that the result names
ReadFile files_of_run(const ReadFile& read, const StoredProvenance& provenance,
                      const std::string& where, const std::string& file);

}  // namespace rigcal::report
