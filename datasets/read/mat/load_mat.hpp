#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether a file is to be read as a MAT file: by its name (.mat) or its first bytes.
bool is_mat_file(const FileStart& start);

/// Wanted columns of a MAT file.
struct MatRequest {
  std::vector<std::string> columns;  ///< MATLAB names (mat_path.hpp), in the order of the result
  std::string time_column;           ///< among `columns`; checked to increase; may be empty
};

/// Reads vectors out of a MAT file of version 5 (also compressed: "v6", "v7") or 7.3, strictly.
///
/// A column is a vector variable, a vector field of a struct, or a row or column of a matrix:
/// "x", "log.time", "log.signals(2).values", "data(:,3)". Arrays of one element are vectors too;
/// dimensions of length 1 do not count. Every real number class is accepted. Everything else is an
/// error: complex, sparse, text, cells, objects (a timeseries is one), NaN and infinity, integers
/// that a double cannot represent, time that does not increase, vectors of different lengths, files
/// that end early or whose compressed data are damaged. At most 12 million numbers are read.
///
/// Version 5 has its own reader here. HDF5 reads version 7.3 in a separate process with limits of
/// memory and time, because a damaged file can crash it or keep it busy forever.
///
/// @return             one vector per column, of the same length
/// @throws InputError  file, column and element, what was found and what was expected
/// @throws std::invalid_argument  time_column is not among the columns
std::vector<std::vector<double>> load_mat(const std::filesystem::path& path,
                                          const MatRequest& request);

/// Every column that load_mat() could read: vectors, and columns of matrices of up to 100 columns,
/// in the order of the file.
///
/// @throws InputError  as load_mat
std::vector<std::string> mat_columns(const std::filesystem::path& path);

/// Functions with the signature of the table of readers (record_reader.hpp).
std::vector<RecordColumn> mat_record_columns(const std::filesystem::path& path);
RecordTable load_mat_record(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
