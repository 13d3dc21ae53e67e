#include "datasets/read/xlsx/xlsx_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "datasets/read/csv/csv_text.hpp"
#include "datasets/read/limits.hpp"
#include "datasets/read/unit_in_name.hpp"
#include "datasets/read/xlsx/xlsx_book.hpp"

namespace rigcal::datasets {
namespace {

/// Returns the text of a header cell on one line. Line breaks, which are common there, become
/// spaces.
std::string on_one_line(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_break = static_cast<unsigned char>(c) <= ' ';
    if (!is_break) result += c;
    if (is_break && !result.empty() && result.back() != ' ') result += ' ';
  }
  return result;
}

/// Returns the unit in a cell below the header: "mm", "[mm]" or "(mm)"; empty for "-". Returns
/// nullopt if the text is not a unit.
std::optional<std::string> unit_in(std::string_view text) {
  if (text.size() > 2 &&
      ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')')))
    text = text.substr(1, text.size() - 2);
  if (text.empty() || text == "-") return std::string();
  const std::string unit = unit_of_text(text);
  return unit.empty() ? std::nullopt : std::optional(unit);
}

std::string kind_text(const XlsxCell& cell) {
  switch (cell.kind) {
    case XlsxKind::date:
      return fmt::format(
          "shows a date or a time of day (stored as {}); expected a number: give the cells the "
          "format of a number, and times in seconds from the start",
          shown(cell.text));
    case XlsxKind::text:
      return fmt::format("is the text '{}'; expected a number", shown(cell.text));
    case XlsxKind::truth:
      return "is a truth value; expected a number";
    case XlsxKind::error:
      return fmt::format("is the error {}; expected a number", shown(cell.text));
    case XlsxKind::no_result:
      return "has a formula without a stored result; open the workbook in Excel and save it again";
    case XlsxKind::number:
      break;
  }
  return fmt::format("is '{}', which is not a finite number; expected one", shown(cell.text));
}

/// The header of a sheet, and the units below it.
struct SheetHeader {
  std::size_t row = 0;             ///< 0: the sheet is empty
  std::vector<CsvName> names;      ///< by column; empty where the header has a gap
  std::vector<std::string> units;  ///< by column; empty without a row of units
  bool has_number = false;
  bool has_text = false;
};

/// A row of a sheet that is not empty.
using SheetRow = std::vector<XlsxCell>;

bool is_text(const SheetRow& row) {
  return std::all_of(row.begin(), row.end(),
                     [](const XlsxCell& cell) { return cell.kind == XlsxKind::text; });
}

/// Whether a row may be one of numbers: it has more of them than texts, such as remarks.
bool is_numbers(const SheetRow& row) {
  const auto count = [&row](XlsxKind kind) {
    return std::count_if(row.begin(), row.end(),
                         [kind](const XlsxCell& cell) { return cell.kind == kind; });
  };
  return count(XlsxKind::number) > count(XlsxKind::text);
}

std::optional<std::string> unit_of_cell(const XlsxCell& cell) {
  return cell.kind == XlsxKind::text ? unit_in(header_name(cell.text).full) : std::nullopt;
}

bool are_units(const SheetRow& row) {
  return std::all_of(row.begin(), row.end(),
                     [](const XlsxCell& cell) { return unit_of_cell(cell).has_value(); });
}

/// Whether each number of a row has a text above it.
bool names_all(const SheetRow& names, const SheetRow& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [&names](const XlsxCell& cell) {
    return cell.kind != XlsxKind::number ||
           std::any_of(names.begin(), names.end(),
                       [&cell](const XlsxCell& name) { return name.column == cell.column; });
  });
}

/// Finds the header while the cells of a sheet are being read. It is the highest of the rows of
/// text directly above the first two rows of numbers (or the last row) that name each of their
/// columns, so that titles may precede it. Without such rows it is the first row.
class HeaderFinder {
 public:
  /// Whether the header is complete, so that this cell belongs to the rows of numbers.
  bool is_past(const XlsxCell& cell) {
    if (cell.row != row_) finish_row();
    row_ = cell.row;
    if (is_known_) return true;
    cells_.push_back(cell);
    return false;
  }

  /// Ends the search at the end of the sheet.
  void finish() {
    finish_row();
    if (is_known_ || pending_.empty()) return;
    const auto above_last = header_above(pending_.size() - 1);
    has_table_ = above_last.has_value();
    settle(above_last.value_or(0));
  }

  /// Returns the cells below the header and its units that have been read.
  std::vector<XlsxCell> take_rows() { return std::exchange(rows_, {}); }
  const SheetHeader& header() const { return header_; }
  /// Whether the header is above rows of numbers.
  bool has_table() const { return has_table_; }

 private:
  void finish_row() {
    if (cells_.empty() || is_known_) return;
    const bool is_comment = pending_.empty() && cells_.front().kind == XlsxKind::text &&
                            std::string_view(cells_.front().text).starts_with('#');
    if (!is_comment) {
      pending_cells_ += cells_.size();
      pending_.push_back(std::move(cells_));
      look();
    }
    cells_.clear();
  }

  /// Settles the header if the last two rows are the first ones of numbers, or if the search has
  /// been long.
  void look() {
    constexpr std::size_t kRowsSearched = 200;
    constexpr std::size_t kCellsSearched = 100'000;
    const std::size_t rows = pending_.size();
    if (rows > 2 && is_numbers(pending_[rows - 1]) && is_numbers(pending_[rows - 2])) {
      if (const auto at = header_above(rows - 2)) {
        has_table_ = true;
        settle(*at);
        return;
      }
    }
    if (rows >= kRowsSearched || pending_cells_ >= kCellsSearched) settle(0);
  }

  /// Returns the index of the header of a row of numbers; nullopt if there is none.
  std::optional<std::size_t> header_above(std::size_t row) const {
    if (!is_numbers(pending_[row])) return std::nullopt;
    std::optional<std::size_t> header;
    for (std::size_t i = row; i-- > 0;) {
      const SheetRow& above = pending_[i];
      const bool is_adjacent = above.front().row + 1 == pending_[i + 1].front().row;
      const bool has_names = names_all(above, pending_[row]);
      if (!is_adjacent || !is_text(above) || !(has_names || are_units(above))) break;
      if (has_names) header = i;
    }
    // An empty row between names and units does not turn the units into names.
    if (header.value_or(0) > 0 && are_units(pending_[*header])) {
      const SheetRow& above = pending_[*header - 1];
      if (is_text(above) && names_all(above, pending_[row])) return *header - 1;
    }
    return header;
  }

  void settle(std::size_t at) {
    is_known_ = true;
    take_names(pending_[at]);
    std::size_t next = at + 1;
    if (next < pending_.size() && take_units(pending_[next])) ++next;
    for (; next < pending_.size(); ++next)
      rows_.insert(rows_.end(), pending_[next].begin(), pending_[next].end());
    pending_.clear();
  }

  void take_names(const SheetRow& row) {
    header_.row = row.front().row;
    for (const XlsxCell& cell : row) {
      const bool is_text = cell.kind == XlsxKind::text;
      (is_text ? header_.has_text : header_.has_number) = true;
      header_.names.resize(cell.column);
      header_.names.back() = header_name(on_one_line(cell.text));
    }
  }

  /// Stores a row as the row of units if it is one, and returns whether it is.
  bool take_units(const SheetRow& row) {
    if (row.front().row != header_.row + 1 || !are_units(row)) return false;
    header_.units.resize(header_.names.size());
    for (const XlsxCell& cell : row)
      if (cell.column <= header_.units.size()) header_.units[cell.column - 1] = *unit_of_cell(cell);
    return true;
  }

  SheetHeader header_;
  std::size_t row_ = 0;
  bool is_known_ = false;
  bool has_table_ = false;
  SheetRow cells_;
  std::vector<SheetRow> pending_;  ///< rows until the header is known
  std::size_t pending_cells_ = 0;
  std::vector<XlsxCell> rows_;
};

// ---- Which sheet, which column -------------------------------------------------------------

struct SheetColumn {
  std::size_t sheet = 0;
  std::string name;  ///< in its header
};

/// Splits names such as "Sheet2!x" and "'My sheet'!x". A name without a sheet refers to the first
/// one.
SheetColumn place_of(const XlsxBook& book, const std::string& column) {
  for (std::size_t at = column.find('!'); at != std::string::npos; at = column.find('!', at + 1)) {
    std::string name = column.substr(0, at);
    if (name.size() > 2 && name.front() == '\'' && name.back() == '\'') {
      name = name.substr(1, name.size() - 2);
      for (std::size_t k = name.find("''"); k != std::string::npos; k = name.find("''", k + 1))
        name.erase(k, 1);
    }
    for (std::size_t i = 0; i < book.sheets().size(); ++i)
      if (book.sheets()[i].name == name) return {i, column.substr(at + 1)};
  }
  return {0, column};
}

std::string sheet_prefix(const std::string& sheet) {
  if (sheet.find_first_of("!'") == std::string::npos) return sheet + "!";
  std::string quoted;
  for (const char c : sheet) quoted += std::string(c == '\'' ? 2 : 1, c);
  return "'" + quoted + "'!";
}

// ---- Numbers of one sheet ------------------------------------------------------------------

/// Reads several columns of one sheet in a single pass.
class SheetReader {
 public:
  SheetReader(const XlsxBook& book, const XlsxBook::Sheet& sheet, std::vector<std::string> names,
              const std::string& time_name)
      : book_(book), sheet_(sheet), names_(std::move(names)), time_name_(time_name) {}

  /// Returns one column per name, all of the same length.
  RecordTable read(std::size_t most_values) {
    most_values_ = most_values;
    HeaderFinder finder;
    const auto merged = book_.read(sheet_, [&](const XlsxCell& cell) {
      if (finder.is_past(cell)) {
        begin(finder);
        take(cell);
      }
      return true;
    });
    finder.finish();
    begin(finder);
    finish_row();
    if (gap_) fail_at_gap(merged);
    if (next_row_ == first_row_)
      throw InputError({book_.name()},
                       fmt::format("{}: no rows below the header in row {}; expected at least one "
                                   "row of numbers",
                                   shown(sheet_.name), finder.header().row));
    RecordTable table;
    for (const std::string& name : names_) {
      table.columns.push_back(values_.at(columns_.at(name)));
      table.labels.push_back(label_of(finder.header(), columns_.at(name)));
    }
    return table;
  }

 private:
  [[noreturn]] void fail(std::size_t row, std::size_t column, const std::string& message) const {
    throw InputError({book_.name()}, fmt::format("{}!{} {}", shown(sheet_.name),
                                                 xlsx_address(row, column), message));
  }

  ColumnLabel label_of(const SheetHeader& header, std::size_t column) const {
    ColumnLabel label{header.names[column - 1].full, {}, {}, 0};
    const bool has_units = !header.units.empty() && !header.units[column - 1].empty();
    if (has_units) label.unit = header.units[column - 1];
    label.place = fmt::format("{}!{}", shown(sheet_.name),
                              xlsx_address(header.row + (has_units ? 1 : 0), column));
    return label;
  }

  /// Prepares for reading the numbers once the header is known.
  void begin(HeaderFinder& finder) {
    if (first_row_ != 0) return;
    const SheetHeader& header = finder.header();
    if (header.row == 0)
      throw InputError({book_.name()}, fmt::format("{} is empty; {}", shown(sheet_.name),
                                                   "expected a header and rows of numbers"));
    if (header.has_number && !header.has_text)
      fail(
          header.row, header.names.size(),
          "and the rest of its row are numbers; expected the header with the names of the columns");
    first_row_ = header.row + (header.units.empty() ? 1 : 2);
    next_row_ = first_row_;
    for (const std::string& name : names_) columns_[name] = column_of(header, name);
    for (const auto& [name, column] : columns_) values_[column];
    for (const XlsxCell& cell : finder.take_rows()) take(cell);
  }

  std::size_t column_of(const SheetHeader& header, const std::string& name) const {
    const auto found = find_column(header.names, name);
    if (!found) {
      std::vector<std::string> known = short_names(header.names);
      std::erase(known, std::string());
      std::vector<std::string> sheets;
      for (const XlsxBook::Sheet& sheet : book_.sheets()) sheets.push_back(sheet.name);
      std::string message = fmt::format("{} row {}: {}", shown(sheet_.name), header.row,
                                        unknown_name_message("column", name, known));
      if (const std::size_t at = name.find('!'); at != std::string::npos)
        message += "; " + unknown_name_message("sheet", name.substr(0, at), sheets);
      throw InputError({book_.name()}, message);
    }
    if (found->second)
      throw InputError({book_.name()},
                       fmt::format("{}: columns {} and {} are both named '{}'; expected one",
                                   shown(sheet_.name), xlsx_address(header.row, found->index + 1),
                                   xlsx_address(header.row, *found->second + 1), name));
    return found->index + 1;
  }

  void take(const XlsxCell& cell) {
    const auto wanted = values_.find(cell.column);
    if (wanted == values_.end() || gap_) return;
    if (cell.row != row_) {
      finish_row();
      if (gap_) return;
      row_ = cell.row;
      if (cell.row != next_row_) {
        gap_ = {next_row_, values_.begin()->first};
        return;
      }
    }
    const auto value = cell.kind == XlsxKind::number ? csv_number(cell.text, false) : std::nullopt;
    if (!value) fail(cell.row, cell.column, kind_text(cell) + hint(cell));
    std::vector<double>& values = wanted->second;
    if (!values.empty() && !time_name_.empty() && columns_.at(time_name_) == cell.column &&
        !(*value > values.back()))
      fail(cell.row, cell.column,
           fmt::format("is {} after {}: time '{}' does not increase; expected a larger value in "
                       "each row",
                       *value, values.back(), time_name_));
    if (++count_ > most_values_)
      fail(cell.row, cell.column,
           fmt::format("is beyond {} numbers, the limit of one file; decimate the record, or split "
                       "it into several files",
                       kMostValues));
    values.push_back(*value);
  }

  /// Checks that every wanted column has a cell in the row that was read.
  void finish_row() {
    if (row_ == 0 || gap_) return;
    const std::size_t rows = row_ - first_row_ + 1;
    for (const auto& [column, values] : values_)
      if (values.size() < rows) {
        gap_ = {row_, column};
        return;
      }
    next_row_ = row_ + 1;
  }

  std::string hint(const XlsxCell& cell) const {
    return cell.row == first_row_ && cell.kind == XlsxKind::text
               ? "; the row below the header may hold units only, such as mm, bar or -"
               : "";
  }

  [[noreturn]] void fail_at_gap(const std::vector<XlsxMerged>& merged) const {
    const auto [row, column] = *gap_;
    for (const XlsxMerged& cells : merged)
      if (cells.holds(row, column))
        fail(row, column,
             fmt::format("belongs to the merged cells {}, of which only the first has content; "
                         "expected a number in each cell",
                         cells.range));
    fail(row, column, "is empty, but rows follow or other columns continue; expected a number");
  }

  const XlsxBook& book_;
  const XlsxBook::Sheet& sheet_;
  std::vector<std::string> names_;
  std::string time_name_;
  std::size_t most_values_ = 0;
  std::size_t count_ = 0;
  std::map<std::string, std::size_t> columns_;         ///< by name
  std::map<std::size_t, std::vector<double>> values_;  ///< by column
  std::size_t first_row_ = 0;  ///< first row of numbers; 0 until it is known
  std::size_t next_row_ = 0;
  std::size_t row_ = 0;
  std::optional<std::pair<std::size_t, std::size_t>> gap_;  ///< the first missing cell
};

}  // namespace

std::vector<RecordColumn> list_xlsx_columns(const std::filesystem::path& path) {
  const XlsxBook book(path);
  struct Sheet {
    std::vector<RecordColumn> columns;
    bool has_table = false;
  };
  std::vector<Sheet> sheets;
  for (std::size_t i = 0; i < book.sheets().size(); ++i) {
    const XlsxBook::Sheet& own = book.sheets()[i];
    HeaderFinder finder;
    book.read(own, [&](const XlsxCell& cell) { return !finder.is_past(cell); });
    finder.finish();
    const SheetHeader& header = finder.header();
    Sheet& sheet = sheets.emplace_back();
    sheet.has_table = finder.has_table();
    if (!header.has_text) continue;
    const std::string prefix = i == 0 ? "" : sheet_prefix(own.name);
    for (std::size_t k = 0; k < header.names.size(); ++k) {
      const std::string& name = header.names[k].full;
      if (name.empty()) continue;
      sheet.columns.push_back(
          {prefix + name, header.units.empty() ? "" : header.units[k], false, false});
    }
  }
  // A sheet of notes beside one of numbers has no columns.
  const bool any_table =
      std::any_of(sheets.begin(), sheets.end(), [](const Sheet& sheet) { return sheet.has_table; });
  std::vector<RecordColumn> columns;
  for (const Sheet& sheet : sheets)
    if (sheet.has_table || !any_table)
      columns.insert(columns.end(), sheet.columns.begin(), sheet.columns.end());
  return columns;
}

RecordTable read_xlsx_columns(const std::filesystem::path& path, const RecordRequest& request) {
  const XlsxBook book(path);
  std::vector<SheetColumn> places;
  for (const std::string& column : request.columns) places.push_back(place_of(book, column));
  RecordTable table;
  table.columns.resize(places.size());
  table.labels.resize(places.size());
  std::size_t values = 0;
  for (std::size_t sheet = 0; sheet < book.sheets().size(); ++sheet) {
    std::vector<std::string> names;
    std::string time_name;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i].sheet != sheet) continue;
      names.push_back(places[i].name);
      if (request.columns[i] == request.time_column) time_name = places[i].name;
    }
    if (names.empty()) continue;
    auto own = SheetReader(book, book.sheets()[sheet], names, time_name)
                   .read(kMostValues - std::min(kMostValues, values));
    values += own.columns.size() * own.columns.front().size();
    for (std::size_t i = 0, k = 0; i < places.size(); ++i) {
      if (places[i].sheet != sheet) continue;
      table.labels[i] = std::move(own.labels[k]);
      table.columns[i] = std::move(own.columns[k++]);
    }
  }
  for (std::size_t i = 1; i < table.columns.size(); ++i)
    if (table.columns[i].size() != table.columns[0].size())
      throw InputError({book.name()},
                       fmt::format("'{}' has {} rows, but '{}' has {}; expected the same number",
                                   request.columns[i], table.columns[i].size(), request.columns[0],
                                   table.columns[0].size()));
  return table;
}

}  // namespace rigcal::datasets
