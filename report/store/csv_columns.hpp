#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "report/json/described.hpp"
#include "report/store/csv_fields.hpp"

// CSV tables whose rows are objects: a list of columns says what each column has of an object.

namespace rigcal::report {

template <typename T>
concept CsvText = std::is_convertible_v<const T&, std::string_view>;
/// An optional value or a pointer to an object.
template <typename T>
concept MayBeAbsent = !CsvText<T> && requires(const T& value) {
  *value;
  static_cast<bool>(value);
};

/// Writes a value as a CSV field: a truth value as 1 or 0, an enumeration by its name, numbers of a
/// list separated by spaces, its texts by "; ".
///
/// @param path  members or functions that lead from the value to the one that is written. The field
///              is empty if an optional value or a pointer on the way is absent.
template <typename T, typename... Path>
std::string csv_field(const T& value, const Path&... path) {
  if constexpr (MayBeAbsent<T>) {
    return value ? csv_field(*value, path...) : std::string();
  } else if constexpr (sizeof...(path) > 0) {
    const auto step = [&](const auto& first, const auto&... rest) {
      return csv_field(std::invoke(first, value), rest...);
    };
    return step(path...);
  } else if constexpr (CsvText<T>) {
    return csv_text(std::string(value));
  } else if constexpr (std::is_enum_v<T>) {
    return std::string(to_string(value));
  } else if constexpr (std::is_same_v<T, bool>) {
    return value ? "1" : "0";
  } else if constexpr (std::is_same_v<T, double>) {
    return csv_number(value);
  } else if constexpr (std::is_integral_v<T>) {
    return fmt::format("{}", value);
  } else if constexpr (std::is_convertible_v<const T&, const std::vector<double>&>) {
    std::vector<std::string> numbers;
    for (const double number : value) numbers.push_back(csv_number(number));
    return fmt::format("{}", fmt::join(numbers, " "));
  } else {
    const std::vector<std::string>& texts = value;
    return csv_text(fmt::format("{}", fmt::join(texts, "; ")));
  }
}

/// The columns of a table with one row per object of type Row.
template <typename Row>
class CsvColumns {
 public:
  /// @param path  leads from a row to the value of the column, as in csv_field()
  template <typename... Path>
  CsvColumns& add(std::string heading, Path... path) {
    columns_.push_back(
        {std::move(heading), [path...](const Row& row) { return csv_field(row, path...); }});
    return *this;
  }

  /// Adds columns of described members. Their keys are the headings.
  template <typename... T>
  CsvColumns& members(T Row::*... member) {
    (add(key_of(member), member), ...);
    return *this;
  }

  /// Writes a line of headings, then a line per row.
  std::string table(const std::vector<Row>& rows) const {
    std::vector<std::string> fields;
    for (const Column& column : columns_) fields.push_back(csv_text(column.heading));
    std::string text = csv_row(fields);
    for (const Row& row : rows) {
      for (std::size_t i = 0; i < fields.size(); ++i) fields[i] = columns_[i].field(row);
      text += csv_row(fields);
    }
    return text;
  }

 private:
  struct Column {
    std::string heading;
    std::function<std::string(const Row&)> field;
  };

  template <typename T>
  static std::string key_of(T Row::*member) {
    const Row row{};
    std::string key;
    Row::describe(row, [&](const char* name, const auto& value) {
      if (static_cast<const void*>(&value) == &(row.*member)) key = described::key_of(name);
    });
    return key;
  }

  std::vector<Column> columns_;
};

}  // namespace rigcal::report
