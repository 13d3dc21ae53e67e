#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// A library that reads files of a format in a process of its own (common/confined.hpp), in words.
struct ConfinedReader {
  std::string_view library;  ///< "HDF5"
  std::string_view format;   ///< "a MAT file"
  std::string_view advice;   ///< what to do with a file that crashes it
};

/// What `read` makes of the file, in a process of its own with limits of memory and time: a crash,
/// a loop or a greedy allocation there refuses the file.
///
/// @param columns  how many `read` returns, of the same length, with a label each or none
/// @param read     may throw InputError of this file, and std::bad_alloc
/// @throws InputError  that of `read`; or the process came to no end
RecordTable load_confined(const std::filesystem::path& path, const ConfinedReader& reader,
                          std::size_t columns, const std::function<RecordTable()>& read);

/// Likewise a list of columns.
std::vector<RecordColumn> list_confined(const std::filesystem::path& path,
                                        const ConfinedReader& reader,
                                        const std::function<std::vector<RecordColumn>()>& list);

}  // namespace rigcal::datasets
