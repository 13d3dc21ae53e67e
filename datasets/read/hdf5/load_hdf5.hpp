#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether to read a file as HDF5, judging by its name (.h5, .hdf5) or by the signature of the
/// format, at the beginning or after a block of 512, 1024 or 2048 bytes.
bool is_hdf5_file(const FileStart& start);

/// Lists every column that load_hdf5_record() can read, with units from attributes.
///
/// @throws InputError  if the file is not HDF5, or is damaged
std::vector<RecordColumn> hdf5_record_columns(const std::filesystem::path& path);

/// Reads vectors from an HDF5 file, strictly.
///
/// A column is a dataset ("/run1/position"), a line of one ("/run1/data(:,2)"), a member of a table
/// ("/run1/table.position") or a line of its arrays ("/run1/table.values(:,2)"). Indices count from
/// 1, in the order in which h5dump and h5py print the dimensions. If samples are equidistant, their
/// times may come from an attribute: "/run1/position@wf_increment". Integers and floating-point
/// numbers of any size and byte order are accepted. Everything else is an error: texts, truth
/// values, NaN and infinity, integers that a double cannot represent, a time that does not
/// increase, and columns of different lengths. So are datasets that were never written, are stored
/// in another file, or are compressed by filters that are not built into HDF5. At most 12 million
/// numbers are read.
///
/// HDF5 runs in a child process with limits on memory and time.
///
/// @throws InputError  if the file is not as described; the message gives file, column and row,
///                     what was found and what was expected
/// @throws std::invalid_argument  if the time column is not among the columns
RecordTable load_hdf5_record(const std::filesystem::path& path, const RecordRequest& request);

/// Advice given if an HDF5 file has no columns.
inline constexpr std::string_view kHowToSaveHdf5 =
    "expected datasets of integers or floating-point numbers, of one or two dimensions, or tables";

/// Variants of hdf5_record_columns() and load_hdf5_record() that start no process, for callers that
/// are already confined.
std::vector<RecordColumn> list_hdf5_here(const std::filesystem::path& path);
RecordTable read_hdf5_here(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
