#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Whether to read a file as an Excel workbook, judging by its name (.xlsx, .xlsm) or its first
/// bytes. These may be those of a ZIP archive, or of an older or encrypted workbook, which is then
/// refused.
bool is_xlsx_file(const FileStart& start);

/// Lists every column that has a name. On sheets other than the first, it begins with the name of
/// the sheet.
///
/// @throws InputError  if the file is not a workbook, or is damaged
std::vector<RecordColumn> xlsx_record_columns(const std::filesystem::path& path);

/// Reads columns of an .xlsx workbook, strictly.
///
/// The header is the first row of a sheet that is not empty and does not begin with "#". A row of
/// units may follow. A column is requested by its name in the header, with or without its unit ("x
/// [mm]", "x"), on the first sheet or on a named one ("Sheet2!x"). Numbers are read as stored, not
/// as displayed, whatever the locale. A formula counts as its last result. Everything else in a
/// wanted column is an error: a gap before its last row, text, truth values, errors such as
/// #DIV/0!, dates and times of day, merged cells, a time that does not increase, and columns of
/// different lengths. At most 12 million numbers are read.
///
/// libzip and Expat run in a child process with limits on memory and time.
///
/// @throws InputError  if the file is not as described; the message gives file, sheet and cell,
///                     what was found and what was expected
/// @throws std::invalid_argument  if the time column is not among the columns
RecordTable load_xlsx_record(const std::filesystem::path& path, const RecordRequest& request);

/// Advice given if a workbook has no columns.
inline constexpr std::string_view kHowToSaveXlsx =
    "expected a sheet with names in its first row and numbers below them";

}  // namespace rigcal::datasets
