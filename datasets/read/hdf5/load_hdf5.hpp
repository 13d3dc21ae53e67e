#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether a file is to be read as an HDF5 file: by its name (.h5, .hdf5), or by the signature of
/// the format, at its beginning or after a block of 512, 1024 or 2048 bytes.
bool is_hdf5_file(const FileStart& start);

/// Every column that load_hdf5_record() can read, with units from attributes.
///
/// @throws InputError  not an HDF5 file, or damaged
std::vector<RecordColumn> hdf5_record_columns(const std::filesystem::path& path);

/// Reads vectors out of an HDF5 file, strictly.
///
/// A column is a dataset "/run1/position", a line of one "/run1/data(:,2)", a member of a table
/// "/run1/table.position" or a line of its arrays "/run1/table.values(:,2)"; indices count from 1
/// and have the order of dimensions in which h5dump and h5py print them. The times of
/// equidistant samples come from an attribute: "/run1/position@wf_increment". Integers and
/// floating-point numbers of any size and byte order are accepted. Everything else is an error:
/// texts, truth values, NaN and infinity, integers that a double cannot represent, datasets that
/// were never written, are stored in another file or compressed by filters that are not built into
/// HDF5, time that does not increase, columns of different lengths. At most 12 million numbers are
/// read.
///
/// HDF5 runs in a child process with limits on memory and time.
///
/// @throws InputError  file, column and row, what was found and what was expected
/// @throws std::invalid_argument  the time column is not among the columns
RecordTable load_hdf5_record(const std::filesystem::path& path, const RecordRequest& request);

/// Advice for an HDF5 file without columns.
inline constexpr std::string_view kHowToSaveHdf5 =
    "expected datasets of integers or floating-point numbers, of one or two dimensions, or tables";

/// Both functions without a new process, for callers that are already confined.
std::vector<RecordColumn> list_hdf5_here(const std::filesystem::path& path);
RecordTable read_hdf5_here(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
