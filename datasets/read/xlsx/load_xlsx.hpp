#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether a file is to be read as a workbook of Excel: by its name (.xlsx, .xlsm), or by the first
/// bytes of a ZIP archive, or of an older or encrypted workbook, which is then refused.
bool is_xlsx_file(const FileStart& start);

/// Every column with a name; names of other sheets than the first begin with that of the sheet.
///
/// @throws InputError  not a workbook, or damaged
std::vector<RecordColumn> xlsx_record_columns(const std::filesystem::path& path);

/// Reads columns of an .xlsx workbook, strictly.
///
/// The first row of a sheet that is not empty and does not begin with "#" is its header; a row of
/// units may follow. A column is requested by its name in the header, with or without its unit
/// ("x [mm]", "x"), on the first sheet or on a named one, "Sheet2!x". Numbers are read as stored,
/// not as displayed, whatever the locale; a formula counts as its last result. Everything else in a
/// wanted column is an error: a gap before its last row, text, truth values, errors such as
/// #DIV/0!, dates and times of day, merged cells, time that does not increase, columns of different
/// lengths. At most 12 million numbers are read.
///
/// libzip and Expat run in a child process with limits on memory and time.
///
/// @throws InputError  file, sheet and cell, what was found and what was expected
/// @throws std::invalid_argument  the time column is not among the columns
RecordTable load_xlsx_record(const std::filesystem::path& path, const RecordRequest& request);

/// Advice for a workbook without columns.
inline constexpr std::string_view kHowToSaveXlsx =
    "expected a sheet with names in its first row and numbers below them";

}  // namespace rigcal::datasets
