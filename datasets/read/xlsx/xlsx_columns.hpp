#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Like xlsx_record_columns() and load_xlsx_record() in load_xlsx.hpp, but without a new process.
///
/// @throws InputError  under the same conditions
std::vector<RecordColumn> list_xlsx_columns(const std::filesystem::path& path);
RecordTable read_xlsx_columns(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
