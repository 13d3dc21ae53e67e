#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Variants of xlsx_record_columns() and load_xlsx_record() in load_xlsx.hpp that start no process,
/// for callers that are already confined.
///
/// @throws InputError  under the conditions of those functions
std::vector<RecordColumn> list_xlsx_columns(const std::filesystem::path& path);
RecordTable read_xlsx_columns(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
