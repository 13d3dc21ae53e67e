#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::report {

/// A numeric table from a result folder.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< shape (names)(rows); NaN where a field is empty

  /// Adds a column. A value that is not finite becomes NaN, as if it was read back from an empty
  /// field.
  ///
  /// @param value  called with the index of each row
  template <typename Value>
  void add(std::string name, std::size_t rows, const Value& value) {
    std::vector<double> values(rows);
    for (std::size_t i = 0; i < rows; ++i) values[i] = static_cast<double>(value(i));
    add(std::move(name), std::move(values));
  }
  void add(std::string name, std::vector<double> values) {
    for (double& value : values)
      if (!std::isfinite(value)) value = std::nan("");
    names.push_back(std::move(name));
    columns.push_back(std::move(values));
  }

  /// Finds a column by its name; null if there is none.
  const std::vector<double>* find(std::string_view name) const;
};

/// Writes a table as CSV: a header, then one line per row. Numbers round-trip exactly; a
/// value that is not finite becomes an empty field.
std::string csv_of(const Table& table);

/// Reads a CSV file in the format of the result writers: comment lines (#), a line of names, then
/// rows of numbers.
///
/// @param file  file name for messages
/// @throws InputError  if a field is not a number, the time (time_s) does not increase, or a row
///                     has a wrong number of fields; names file, line and column
Table parse_table(std::string_view text, const std::string& file);

}  // namespace rigcal::report
