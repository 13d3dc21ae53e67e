#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::report {

/// A numeric table of a result folder, read back.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< shape (names)(rows); NaN where a field is empty

  /// @param value  of each row
  template <typename Value>
  void add(std::string name, std::size_t rows, const Value& value) {
    names.push_back(std::move(name));
    std::vector<double>& column = columns.emplace_back(rows);
    for (std::size_t i = 0; i < rows; ++i) column[i] = static_cast<double>(value(i));
  }
  void add(std::string name, std::vector<double> values) {
    names.push_back(std::move(name));
    columns.push_back(std::move(values));
  }

  /// A column by its name; null if the table does not have it.
  const std::vector<double>* find(std::string_view name) const;
};

/// A header and a row for each sample. Numbers read back to the same bits; a missing number is
/// empty.
std::string csv_of(const Table& table);

/// Reads a CSV file as the result writers of this project make them: lines of comment (#), one line
/// of names, then numbers.
///
/// @param file  named in errors
/// @throws InputError  a field is no number, a time (time_s) does not increase, or a row has
///                     another number of fields: names file, line and column
Table parse_table(std::string_view text, const std::string& file);

}  // namespace rigcal::report
