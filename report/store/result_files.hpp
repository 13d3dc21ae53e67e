#pragma once

#include <any>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/file.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_provenance.hpp"
#include "report/store/table.hpp"

// The files from one run belong together. The JSON result lists the others with their SHA-256, so
// that readers can refuse files from another run. A file that this process has made keeps the
// object that it was written from, so that the page need not parse its text.

namespace rigcal::report {

/// Returns a file, given its path in the result folder; null if it is missing.
using ReadFile = std::function<std::shared_ptr<const ResultFile>(const std::filesystem::path&)>;

/// Returns a reader for a folder on disk. It throws InputError if a file cannot be read.
ReadFile files_in(const std::filesystem::path& folder);

/// Returns a reader for files in memory. The files must outlive the reader.
ReadFile files_in(const std::vector<ResultFile>& files);

/// Returns a reader that takes what `first` does not have from `second`.
ReadFile either(ReadFile first, ReadFile second);

/// Makes a JSON file from a described struct, or from JSON.
///
/// @param text  json_text or json_line
template <typename T>
ResultFile json_file(std::filesystem::path path, T object,
                     std::string (*text)(const Json&) = json_text) {
  ResultFile file{std::move(path), text(json_of(object))};
  file.sha256 = sha256_of_text(file.content);
  as_read_back(object);
  file.object = std::make_shared<const T>(std::move(object));
  return file;
}

/// Makes a CSV file from a table.
ResultFile table_file(std::filesystem::path path, Table table);

/// Returns the object that this process wrote a file from; null if there is none of this type, or
/// no file.
template <typename T>
std::shared_ptr<const T> made(const std::shared_ptr<const ResultFile>& file) {
  if (file == nullptr) return nullptr;
  const auto* object = std::any_cast<std::shared_ptr<const T>>(&file->object);
  return object == nullptr ? nullptr : *object;
}

/// Fills `provenance.files` with the path and SHA-256 of each of `files`, in order, and also stores
/// the hashes in `files`.
///
/// @param named  files that are already written; they come first in `provenance.files`
void name_files(std::vector<ResultFile>& files, StoredProvenance& provenance,
                std::vector<InputFile> named = {});

/// Returns a reader that accepts only files from the same run as the result.
///
/// @param read  reads from the folder
/// @param provenance  provenance of the result; if an older version wrote it, it lists no files,
///                    and the reader accepts any file
/// @param where  the folder, for messages
/// @param file  name of the result, for messages
/// @return  reader that throws InputError if the hash of a file is not the listed one
ReadFile files_of_run(const ReadFile& read, const StoredProvenance& provenance,
                      const std::string& where, const std::string& file);

/// Returns the table in a file; null if the file is missing.
///
/// @param where  the folder, for messages
/// @throws InputError  under the conditions of parse_table()
std::shared_ptr<const Table> table_in(const ReadFile& read, const std::string& where,
                                      const std::string& name);

}  // namespace rigcal::report
