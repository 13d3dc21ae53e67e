#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal::report {

/// Number of characters that a terminal shows of a UTF-8 text: sequences that colour it take none.
std::size_t text_width(std::string_view text);

/// Control characters as blanks, but for sequences that colour: names of files may hold any.
std::string on_one_line(std::string text);

/// A line broken between words where it is wider than `columns`, every further line after `indent`
/// blanks; a word that is wider alone stays whole. 0 columns: not broken.
std::string wrapped(std::string_view line, std::size_t columns, std::size_t indent);

/// Every line of a text wrapped, further lines two blanks deeper than its own.
std::string wrapped_lines(std::string_view text, std::size_t columns);

/// Rows of texts as aligned columns: texts to the left, numbers to the right.
class TextTable {
 public:
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::left;
    int spare = 0;  ///< the highest is left out first where there is no room; 0: never
  };

  /// @param keys  number of leading columns that identify a row
  explicit TextTable(std::vector<Column> columns, std::size_t keys = 1)
      : columns_(std::move(columns)), keys_(keys) {}
  /// @param row  shape (columns); line ends and other control characters become blanks
  void add(std::vector<std::string> row);
  /// @param row  shape (columns), each cell as lines one below the other
  void add_lines(std::vector<std::vector<std::string>> row);
  bool empty() const { return rows_.empty(); }
  std::size_t rows() const { return rows_.size(); }
  /// Title line, unless no column has a title, and rows; two blanks between columns, without blanks
  /// at line ends.
  ///
  /// @param columns  of the terminal: columns that can be spared are omitted until the lines fit;
  ///                 if they are still too wide, further blocks follow, each with the keys; 0: no
  ///                 limit
  std::string text(std::size_t columns = 0) const;
  /// Width of the widest line.
  std::size_t width() const;
  /// Titles of the columns that text() omits.
  std::vector<std::string> left_out(std::size_t columns) const;

 private:
  std::vector<std::size_t> widths() const;
  /// Whether each column is shown.
  std::vector<bool> shown(std::size_t columns) const;
  /// The shown columns in blocks, the keys in each.
  std::vector<std::vector<std::size_t>> blocks(std::size_t columns) const;

  std::vector<Column> columns_;
  std::size_t keys_;
  std::vector<std::vector<std::vector<std::string>>> rows_;  ///< lines of each cell
};

}  // namespace rigcal::report
