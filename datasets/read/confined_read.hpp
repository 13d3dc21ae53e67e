#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// A library that reads files of a format in a separate process (common/confined.hpp), in words.
struct ConfinedReader {
  std::string_view library;  ///< "HDF5"
  std::string_view format;   ///< "a MAT file"
  std::string_view advice;   ///< advice for a file that crashes it
};

/// Calls `read` in a separate process with limits of memory and time. A crash, an endless loop or
/// an excessive allocation there becomes an error about the file.
///
/// @param columns  number of columns of equal length that `read` returns, each with a label or none
/// @param read     may throw InputError of this file, and std::bad_alloc
/// @throws InputError  from `read`, or the process did not finish
RecordTable load_confined(const std::filesystem::path& path, const ConfinedReader& reader,
                          std::size_t columns, const std::function<RecordTable()>& read);

/// The same for a list of columns.
std::vector<RecordColumn> list_confined(const std::filesystem::path& path,
                                        const ConfinedReader& reader,
                                        const std::function<std::vector<RecordColumn>()>& list);

}  // namespace rigcal::datasets
