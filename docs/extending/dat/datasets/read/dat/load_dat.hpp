#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Columns of numbers with blanks between them, as gnuplot reads them, below a line "# t_s x_mm"
/// that names them. For data of instruments that write nothing else.
bool is_dat_file(const FileStart& start);
std::vector<RecordColumn> dat_columns(const std::filesystem::path& path);
RecordTable load_dat(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
