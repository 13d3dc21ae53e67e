#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// A file format for recordings.
struct RecordReader {
  std::string_view name;        ///< "MAT"
  std::string_view extensions;  ///< used by `init` to find recordings in a folder: ".h5 .hdf5"
  bool (*sniff)(const FileStart& start);
  /// Lists every column that `load` can read, in file order.
  /// @throws InputError  if the file cannot be read
  std::vector<RecordColumn> (*columns)(const std::filesystem::path& path);
  /// Reads the requested columns.
  /// @throws InputError  if they cannot be read; the message gives the file and the place in it,
  ///                     what was found and what was expected
  /// @throws std::invalid_argument  if the time column is not among the columns
  RecordTable (*load)(const std::filesystem::path& path, const RecordRequest& request);
  std::string_view if_empty;  ///< advice if a file has no columns
};

/// Returns the format of a file: the first one in the table that accepts it. CSV accepts whatever
/// no other format accepts.
/// @throws InputError  if the file has a known format that rigcal does not read
const RecordReader& record_reader(const std::filesystem::path& path);

/// Whether a file is named like a recording in a format that rigcal reads.
bool has_record_name(const std::filesystem::path& path);

/// Whether a file may be a recording, judging by its name. This includes ".txt" and ".dat",
/// although other text files use these, too.
bool may_be_recording(const std::filesystem::path& path);

/// Whether a file is named like a recording in a format that rigcal does not read.
bool has_other_format_name(const std::filesystem::path& path);

/// Return the names and extensions of all formats, for messages: "CSV, MAT or ...", ".csv, .mat or
/// ...".
std::string record_format_names();
std::string record_extensions();

}  // namespace rigcal::datasets
