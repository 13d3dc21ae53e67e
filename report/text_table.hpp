#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal::report {

/// Number of characters of a UTF-8 text.
std::size_t text_width(std::string_view text);

/// Rows of texts as aligned columns: texts to the left, columns that hold numbers to the right.
class TextTable {
 public:
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::left;
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// @param row  shape (columns)
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.empty(); }
  std::size_t rows() const { return rows_.size(); }
  /// Title line and rows, two blanks between columns, without blanks at line ends.
  std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace rigcal::report
