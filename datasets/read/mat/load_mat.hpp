#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether to read a file as a MAT file, judging by its name (.mat) or its first bytes.
bool is_mat_file(const FileStart& start);

/// Lists every column that load_mat_record() can read, in file order: vectors, and the columns of
/// matrices with up to 100 columns.
std::vector<RecordColumn> mat_record_columns(const std::filesystem::path& path);

/// Reads vectors from a MAT file of version 5 (also compressed: "v6", "v7") or 7.3, strictly.
///
/// A column is a vector variable, a vector field of a struct, or a row or column of a matrix: "x",
/// "log.time", "log.signals(2).values", "data(:,3)". Arrays with one element are vectors, too;
/// dimensions of length 1 do not count. Every real number class is accepted. Everything else is an
/// error: complex and sparse arrays, text, cells, objects (such as a timeseries), NaN and infinity,
/// integers that a double cannot represent, a time that does not increase, vectors of different
/// lengths, and files that end early or whose compressed data are damaged. At most 12 million
/// numbers are read.
///
/// Version 5 is read by Level5Source. Version 7.3 is read by HDF5 in a separate process with limits
/// on memory and time, because a damaged file can crash HDF5 or keep it busy forever.
///
/// @throws InputError  if the file is not as described; the message gives file, column and element,
///                     what was found and what was expected
/// @throws std::invalid_argument  if the time column is not among the columns
RecordTable load_mat_record(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
