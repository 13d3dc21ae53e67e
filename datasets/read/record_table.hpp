#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Beginning of a file, used to identify its format.
struct FileStart {
  std::string extension;  ///< in lower case, including the dot
  std::string bytes;      ///< the first 4096; fewer if the file is shorter
};

/// A column that a file offers.
struct RecordColumn {
  std::string name;      ///< as requested in a campaign file
  std::string unit;      ///< given by the file separately from the name; else empty
  bool is_time = false;  ///< whether the format itself marks it as the time
  /// Whether it is a row or column of a matrix, without a name of its own. The first may be the
  /// time.
  bool is_matrix_line = false;

  bool operator==(const RecordColumn&) const = default;
};

/// Columns wanted from a file.
struct RecordRequest {
  std::vector<std::string> columns;  ///< in the order of the result
  std::string time_column;           ///< one of `columns`, checked to increase; may be empty
  char separator = 0;                ///< for text files; 0: detected
  /// For text files: whether to leave out rows that lack a number, rather than refuse the file.
  bool leaves_out_rows = false;
};

/// @throws std::invalid_argument  if the time column is not among the columns
inline void require_time_column(const RecordRequest& request) {
  const auto& columns = request.columns;
  if (!request.time_column.empty() &&
      std::find(columns.begin(), columns.end(), request.time_column) == columns.end())
    throw std::invalid_argument("the time column '" + request.time_column +
                                "' is not among the columns");
}

/// Labels that a file gives for a requested column.
struct ColumnLabel {
  std::string name;   ///< name in the file, including the unit if the name contains it
  std::string unit;   ///< given by the file separately from the name; else empty
  std::string place;  ///< where the file gives the unit: "Log!C2"; empty if in the name
  long line = 0;      ///< line of the name in a text file; 0 in other files
};

struct RecordTable {
  std::vector<std::vector<double>> columns;  ///< one per requested name, all of the same length
  std::string warning;                       ///< doubts about the file; usually empty
  std::vector<ColumnLabel> labels{};         ///< one per requested name, or none
  std::string left_out{};                    ///< which rows were left out, in words; else empty
};

}  // namespace rigcal::datasets
