#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/mat/mat_array.hpp"

namespace rigcal::datasets {

/// Advice on how to save data in a form that programs other than MATLAB can read.
inline constexpr std::string_view kHowToSaveMat =
    "to read a timeseries, save its numbers: t = ts.Time; x = squeeze(ts.Data); save file.mat t x; "
    "or log to a \"Structure With Time\"";

/// Reads one column of a MAT file, given its name in MATLAB: "x", "log.time",
/// "log.signals(2).values(:,1)".
///
/// @param values_so_far  number of values already read from the file, which count towards the limit
/// @throws InputError  if the column cannot be read; the message gives file, column and element,
///                     what was found and what was expected
std::vector<double> read_mat_column(MatSource& source, const std::string& column,
                                    std::size_t values_so_far);

/// Lists every column that read_mat_column() can read, in file order: vectors, and the columns of
/// matrices with up to 100 columns.
std::vector<std::string> list_mat_columns(const MatSource& source);

}  // namespace rigcal::datasets
