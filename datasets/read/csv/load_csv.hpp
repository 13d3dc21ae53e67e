#pragma once

#include <filesystem>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Lists the columns that the header of a CSV file names.
std::vector<RecordColumn> csv_record_columns(const std::filesystem::path& path);

/// Reads the wanted columns of a CSV file, strictly.
///
/// If no line names the columns, they are called "1", "2" and so on. The header is the first line
/// that is not a comment ("#..."), or is found by find_layout(): below lines of text, with spaces
/// as separators, or above a row of units. A unit may follow the name
/// ("x [mm]", "x (mm)") and is not part of it. CRLF, a byte-order mark and a missing final newline
/// are accepted, as is a decimal comma if the separator is ';' or tab, or if the number is between
/// double quotes and not every such comma may be between thousands. Anything else in a wanted
/// column that is not a finite number is an error. Where each value has a column of times before it
/// and all of these have one name, the first is the time, and those of the wanted columns must be
/// the same. The header may occur again where the times go on, and text may follow the last row:
/// a warning says so. Other errors are a wrong number of columns, an
/// empty field, a time that does not increase, and a binary file. Columns that are not wanted are
/// counted but not converted. A requested name may include its unit, and must do so if only the
/// unit distinguishes two columns. At most 12 million numbers are read (96 MB), from at most 4 GiB.
///
/// A warning says why the file may have been cut off within its last number: it ends without a
/// newline, and that number has fewer characters than all others in its column. Another says which
/// order of day and month was assumed where time stamps have two readings (StampClock).
///
/// @throws InputError  if the file is not as described; the message gives file:line:column (the
///                     position of the field in characters, from 1), what was found and what was
///                     expected
/// @throws std::invalid_argument  if time_column is not among the columns
RecordTable load_csv_record(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
