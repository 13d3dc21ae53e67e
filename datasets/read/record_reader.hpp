#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// A format of recordings.
struct RecordReader {
  std::string_view name;        ///< "MAT"
  std::string_view extensions;  ///< by which `init` finds recordings in a folder: ".h5 .hdf5"
  bool (*sniff)(const FileStart& start);
  /// Every column that `load` could read, in the order of the file.
  /// @throws InputError
  std::vector<RecordColumn> (*columns)(const std::filesystem::path& path);
  /// @throws InputError  file and place within it, what was found and what was expected
  /// @throws std::invalid_argument  the time column is not among the columns
  RecordTable (*load)(const std::filesystem::path& path, const RecordRequest& request);
  std::string_view if_empty;  ///< advice for a file without columns
};

/// Format of a file: the first of the table that accepts it. CSV accepts what no other does.
/// @throws InputError  the file has a known format that rigcal does not read
const RecordReader& record_reader(const std::filesystem::path& path);

/// Whether the name of a file is that of a recording.
bool has_record_name(const std::filesystem::path& path);

/// Whether it may be that of one: text files have it, too (".txt", ".dat").
bool may_be_recording(const std::filesystem::path& path);

/// Whether it is that of a recording in a format that is not read.
bool has_other_format_name(const std::filesystem::path& path);

/// Names and extensions of all formats, for messages: "CSV, MAT or ...", ".csv, .mat or ...".
std::string record_format_names();
std::string record_extensions();

}  // namespace rigcal::datasets
