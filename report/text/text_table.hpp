#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal::report {

/// Returns the number of columns that a UTF-8 text takes on a terminal. Colour sequences take none.
std::size_t text_width(std::string_view text);

/// Replaces control characters with spaces, since file names may contain any. Keeps colour
/// sequences.
std::string on_one_line(std::string text);

/// Breaks a line between words so that it fits into `columns`. Continuation lines begin with
/// `indent` spaces. A single word that is too wide is not broken; with 0 columns nothing is.
std::string wrapped(std::string_view line, std::size_t columns, std::size_t indent);

/// Wraps every line of a text. Continuation lines are indented by two more spaces than the line.
std::string wrapped_lines(std::string_view text, std::size_t columns);

/// Formats rows of texts as aligned columns.
class TextTable {
 public:
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::left;
    int spare = 0;  ///< without room, the highest is omitted first; 0: never omitted
  };

  /// @param keys  number of leading columns that identify a row
  explicit TextTable(std::vector<Column> columns, std::size_t keys = 1)
      : columns_(std::move(columns)), keys_(keys) {}
  /// @param row  shape (columns); line ends and other control characters become spaces
  void add(std::vector<std::string> row);
  /// @param row  shape (columns); each cell is a list of lines
  void add_lines(std::vector<std::vector<std::string>> row);
  bool empty() const { return rows_.empty(); }
  std::size_t rows() const { return rows_.size(); }
  /// Writes the title line, if any column has a title, and the rows. Columns are separated by two
  /// spaces; lines have no trailing spaces.
  ///
  /// @param columns  width of the terminal. Spare columns are omitted until the lines fit; if the
  ///                 lines are still too wide, the table is split into blocks that all begin with
  ///                 the keys. 0: no limit
  std::string text(std::size_t columns = 0) const;
  std::size_t width() const;
  /// Returns the titles of the columns that text() omits.
  std::vector<std::string> left_out(std::size_t columns) const;

 private:
  std::vector<std::size_t> widths() const;
  /// Returns, for each column, whether it is shown.
  std::vector<bool> shown(std::size_t columns) const;
  /// Splits the shown columns into blocks, each with the keys.
  std::vector<std::vector<std::size_t>> blocks(std::size_t columns) const;

  std::vector<Column> columns_;
  std::size_t keys_;
  std::vector<std::vector<std::vector<std::string>>> rows_;  ///< lines of each cell
};

}  // namespace rigcal::report
