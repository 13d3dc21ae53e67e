#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Columns wanted from a file, and the layout of its text.
struct CsvRequest {
  std::vector<std::string> columns;  ///< header names, in the order of the result
  char separator = 0;                ///< 0: detected from the header (',' ';' or tab)
  std::string time_column;           ///< one of `columns`, checked to increase; may be empty
  std::size_t max_bytes = std::size_t{4} << 30;  ///< larger files are refused
  /// Whether to leave out rows in which a wanted column has no finite number, rather than refuse
  /// the file.
  bool leaves_out_rows = false;
};

struct CsvTable {
  std::vector<std::vector<double>> columns;  ///< one per requested name, same length each
  long first_data_line = 0;                  ///< line number of the first row, for messages
  /// Explains, in words, why the file may have been cut off within its last number: it ends without
  /// a newline, and that number has fewer characters than all others in its column. Otherwise
  /// empty.
  std::string cut_short;
  std::vector<ColumnLabel> labels{};  ///< one per requested name
  std::string left_out{};             ///< which rows were left out, in words; else empty
};

/// Reads the wanted columns of a CSV file, strictly.
///
/// If no line names the columns, they are called "1", "2" and so on. The header is the first line
/// that is not a comment ("#..."), or is found by find_layout(): below lines of text, with spaces
/// as separators, or above a row of units. A unit may follow the name
/// ("x [mm]", "x (mm)") and is not part of it. CRLF, a byte-order mark and a missing final newline
/// are accepted, as is a decimal comma if the separator is ';' or tab. Anything else in a wanted
/// column that is not a finite number is an error. Other errors are a wrong number of columns, an
/// empty field, a time that does not increase, and a binary file. Columns that are not wanted are
/// counted but not converted. A requested name may include its unit, and must do so if only the
/// unit distinguishes two columns. At most 12 million numbers are read (96 MB).
///
/// @throws InputError  if the file is not as described; the message gives file:line:column (the
///                     position of the field in characters, from 1), what was found and what was
///                     expected
/// @throws std::invalid_argument  if time_column is not among the columns
CsvTable load_csv(const std::filesystem::path& path, const CsvRequest& request);

/// These functions have the signatures that the table of readers requires (record_reader.hpp).
std::vector<RecordColumn> csv_record_columns(const std::filesystem::path& path);
RecordTable load_csv_record(const std::filesystem::path& path, const RecordRequest& request);

}  // namespace rigcal::datasets
