#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Describes, for messages, a library that reads a file format in a separate process
/// (common/confined.hpp).
struct ConfinedReader {
  std::string_view library;  ///< "HDF5"
  std::string_view format;   ///< "a MAT file"
  std::string_view advice;   ///< advice for a file that crashes the library
};

/// Calls `read` in a separate process with limits on memory and time. A crash, an endless loop or
/// an excessive allocation in that process is reported as an error about the file.
///
/// @param columns  number of columns that `read` returns, all of the same length; labels are
///                 optional
/// @param read     may throw InputError about this file, and std::bad_alloc
/// @throws InputError  if `read` throws it, or if the process does not finish
RecordTable load_confined(const std::filesystem::path& path, const ConfinedReader& reader,
                          std::size_t columns, const std::function<RecordTable()>& read);

/// Calls a function that lists columns in a separate process, with the limits and errors of
/// load_confined().
std::vector<RecordColumn> list_confined(const std::filesystem::path& path,
                                        const ConfinedReader& reader,
                                        const std::function<std::vector<RecordColumn>()>& list);

}  // namespace rigcal::datasets
