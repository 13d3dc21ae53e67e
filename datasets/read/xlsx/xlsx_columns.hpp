#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// The functions of load_xlsx.hpp in this process.
///
/// @throws InputError
std::vector<RecordColumn> list_xlsx_columns(const std::filesystem::path& path);
RecordTable read_xlsx_columns(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
