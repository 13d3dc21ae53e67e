#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Beginning of a file, which identifies its format.
struct FileStart {
  std::string extension;  ///< in lower case, with its dot
  std::string bytes;      ///< the first 4096; fewer of a shorter file
};

/// A column that a file offers.
struct RecordColumn {
  std::string name;      ///< as requested in a campaign file
  std::string unit;      ///< unit that the file gives separately from the name; else empty
  bool is_time = false;  ///< the format itself says so
  /// A row or column of a matrix, without a name of its own; the first may be the time.
  bool is_matrix_line = false;

  bool operator==(const RecordColumn&) const = default;
};

/// Wanted columns of a file.
struct RecordRequest {
  std::vector<std::string> columns;  ///< in the order of the result
  std::string time_column;           ///< among `columns`; checked to increase; may be empty
  char separator = 0;                ///< separator of a text; 0: detected
};

/// @throws std::invalid_argument  the time column is not among the columns
inline void require_time_column(const RecordRequest& request) {
  const auto& columns = request.columns;
  if (!request.time_column.empty() &&
      std::find(columns.begin(), columns.end(), request.time_column) == columns.end())
    throw std::invalid_argument("the time column '" + request.time_column +
                                "' is not among the columns");
}

/// Labels in a file for a column that was asked for.
struct ColumnLabel {
  std::string name;   ///< name in the file, including the unit if that is part of it
  std::string unit;   ///< unit that the file gives separately from the name; else empty
  std::string place;  ///< where the file gives the unit: "Log!C2"; empty: in the name
  long line = 0;      ///< line of the name in a text file; else 0
};

struct RecordTable {
  std::vector<std::vector<double>> columns;  ///< one per wanted name, of the same length
  std::string warning;                       ///< doubts about the file; mostly empty
  std::vector<ColumnLabel> labels{};         ///< one per wanted name, or none
};

}  // namespace rigcal::datasets
