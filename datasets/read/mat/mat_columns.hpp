#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/mat/mat_array.hpp"

namespace rigcal::datasets {

/// Advice for saving what only MATLAB can read.
inline constexpr std::string_view kHowToSaveMat =
    "of a timeseries save its numbers: t = ts.Time; x = squeeze(ts.Data); save file.mat t x; or "
    "log to a \"Structure With Time\"";

/// One column of a MAT file, by its name in MATLAB (mat_path.hpp).
///
/// @param values_so_far  numbers already read from the file; it counts against the limit
/// @throws InputError  file, column and element, what was found and what was expected
std::vector<double> read_mat_column(MatSource& source, const std::string& column,
                                    std::size_t values_so_far);

/// Every column that read_mat_column() could read: vectors, and columns of matrices of up to 100
/// columns, in the order of the file.
std::vector<std::string> list_mat_columns(const MatSource& source);

}  // namespace rigcal::datasets
