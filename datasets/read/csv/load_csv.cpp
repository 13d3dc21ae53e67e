#include "datasets/read/csv/load_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "common/error.hpp"
#include "common/parse_double.hpp"
#include "common/suggest.hpp"
#include "datasets/read/csv/csv_layout.hpp"
#include "datasets/read/csv/csv_lines.hpp"
#include "datasets/read/csv/csv_text.hpp"
#include "datasets/read/csv/lvm_header.hpp"
#include "datasets/read/csv/stamp_clock.hpp"
#include "datasets/read/csv/time_stamp.hpp"
#include "datasets/read/limits.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kMostColumns = 10'000;
constexpr std::size_t kMostCsvBytes = std::size_t{4} << 30;

constexpr std::size_t kMostHeadLines = 500;  // number of lines searched for the header
constexpr std::size_t kMostHeadBytes = 4'000'000;

struct Header {
  std::string file;
  long line = 0;
  char separator = ',';
  std::vector<CsvName> names;
  std::vector<std::string> units{};  ///< one per name; empty without a row of units
  long units_line = 0;
  bool last_may_lack = false;         ///< the last column is a comment that rows may omit
  bool is_unnamed = false;            ///< no line names the columns
  std::optional<RegularTime> time{};  ///< a .lvm without a column of times has it
  std::string text{};                 ///< the line of names
  std::string units_text{};           ///< the row of units directly below it, if there is one
  /// Whether each value has a column of times before it, all of one name.
  bool in_pairs = false;
};

/// Whether columns alternate between times, which share a name, and values.
bool are_pairs(const std::vector<CsvName>& names) {
  if (names.size() < 4 || names.size() % 2 != 0 || names.front().full.empty()) return false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if ((names[i].full == names.front().full) != (i % 2 == 0)) return false;
  return true;
}

/// Lines of a file. The first lines can be inspected before they are read.
class HeadedLines {
 public:
  explicit HeadedLines(CsvLines& lines) : lines_(lines) {}

  /// Returns up to `count` lines from the beginning, within the limits for the head.
  const std::vector<std::string>& look_ahead(std::size_t count) {
    std::size_t bytes = 0;
    for (const std::string& line : head_) bytes += line.size();
    while (head_.size() < std::min(count, kMostHeadLines) && bytes < kMostHeadBytes && !ended_) {
      const char* text = lines_.next();
      ended_ = text == nullptr;
      if (ended_) break;
      head_.emplace_back(text);
      bytes += head_.back().size();
    }
    return head_;
  }
  /// Whether look_ahead() has reached the end of the file.
  bool ended() const { return ended_; }

  /// Returns the next line, or null after the last.
  const char* next() {
    if (taken_ < head_.size()) {
      ++number_;
      return head_[taken_++].c_str();
    }
    const char* text = ended_ ? nullptr : lines_.next();
    if (text != nullptr) ++number_;
    return text;
  }
  /// Returns the number of the line that next() last returned, from 1.
  long number() const { return number_; }

 private:
  CsvLines& lines_;
  std::vector<std::string> head_;
  std::size_t taken_ = 0;
  long number_ = 0;
  bool ended_ = false;
};

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '#';
}

bool has_control_characters(std::string_view line) {
  return std::any_of(line.begin(), line.end(),
                     [](char c) { return c >= 0 && c < ' ' && c != '\t'; });
}

std::string_view separator_name(char separator) {
  return separator == '\t' ? "tab" : separator == ';' ? "';'" : separator == ' ' ? "blanks" : "','";
}

// ---- Header --------------------------------------------------------------------------------

/// Whether the first line is the header, as in most files: it is followed by a row with the same
/// number of fields, all of them numbers.
bool header_comes_first(const std::vector<std::string>& lines, char separator) {
  const auto is_wanted = [](const std::string& line) { return !is_comment(line); };
  const auto header = std::find_if(lines.begin(), lines.end(), is_wanted);
  if (header == lines.end() || is_blank(*header)) return false;
  const auto row =
      std::find_if(header + 1, lines.end(), [](const auto& l) { return !is_blank(l); });
  if (row == lines.end()) return false;
  const char by = separator != 0 ? separator : find_separator(*header);
  const std::size_t names = header_names(*header, by).size();
  return is_row_of_numbers(*row, by, names) && !is_row_of_numbers(*header, by, names);
}

/// Whether the first line that is not a comment cannot be a header: it contains numbers, or no
/// separator.
bool lacks_names(const std::vector<std::string>& lines, char separator) {
  const auto first = std::find_if(lines.begin(), lines.end(),
                                  [](const std::string& line) { return !is_comment(line); });
  if (first == lines.end() || is_blank(*first) || has_control_characters(*first)) return false;
  const char by = separator != 0 ? separator : find_separator(*first);
  const std::size_t names = header_names(*first, by).size();
  return names == 1 || is_row_of_numbers(*first, by, names);
}

/// Finds a header below lines of text, with spaces as separators, or above a row of units; nullopt
/// for other files.
std::optional<Header> unusual_header(HeadedLines& lines, const std::string& file, char separator) {
  if (header_comes_first(lines.look_ahead(10), separator)) return std::nullopt;
  const auto& head = lines.look_ahead(kMostHeadLines);
  const auto layout = find_layout(head, lines.ended(), separator);
  if (!layout || layout->names.size() > kMostColumns) return std::nullopt;
  Header header{
      file, static_cast<long>(layout->header) + 1, layout->separator, layout->names, layout->units,
      0};
  header.last_may_lack = layout->last_may_lack;
  if (!header.units.empty()) header.units_line = static_cast<long>(layout->units_line) + 1;
  header.text = head[layout->header];
  if (!layout->units.empty() && layout->units_line == layout->header + 1)
    header.units_text = head[layout->units_line];
  const auto lvm =
      lvm_header(std::span(head).first(layout->header), layout->separator, layout->names);
  if (lvm) header.time = lvm->time;
  if (lvm && lvm->time && lvm->first_is_empty) header.names.front() = {};
  if (lvm && header.units.empty() && !lvm->units.empty()) {
    header.units = lvm->units;
    header.units_line = static_cast<long>(lvm->units_line) + 1;
  }
  while (lines.number() < static_cast<long>(layout->data)) lines.next();
  return header;
}

/// Finds columns that no line names.
std::optional<Header> unnamed_header(HeadedLines& lines, const std::string& file, char separator) {
  const auto& head = lines.look_ahead(kMostHeadLines);
  const auto layout = find_unnamed(head, lines.ended(), separator);
  if (!layout || layout->names.size() > kMostColumns) return std::nullopt;
  Header header{file, static_cast<long>(layout->data) + 1, layout->separator, layout->names};
  header.is_unnamed = true;
  while (lines.number() < static_cast<long>(layout->data)) lines.next();
  return header;
}

Header read_header(HeadedLines& lines, const std::string& file, char separator) {
  if (separator != 0 && separator != ',' && separator != ';' && separator != '\t' &&
      separator != ' ')
    throw InputError(
        {file},
        fmt::format("'{}' cannot separate columns; expected ',', ';', tab or a blank", separator));
  if (auto header = unusual_header(lines, file, separator)) {
    header->in_pairs = are_pairs(header->names);
    return *header;
  }
  if (lacks_names(lines.look_ahead(10), separator))
    if (auto header = unnamed_header(lines, file, separator)) return *header;
  const char* text = lines.next();
  while (text != nullptr && is_comment(text)) text = lines.next();
  if (text == nullptr)
    throw InputError({file},
                     lines.number() == 0
                         ? "is empty; expected a header line with the names of the columns"
                         : "contains comments only; expected a header line with the names of "
                           "the columns");
  const std::string_view line = text;
  const auto fail = [&](const std::string& message) {
    throw InputError({file, lines.number(), 1}, message);
  };
  if (is_blank(line)) fail("is an empty line; expected the header with the names of the columns");
  if (line.find('\r') != std::string_view::npos)
    fail("lines end with a carriage return alone; expected line ends of Unix or Windows");
  if (has_control_characters(line))
    fail("contains control characters; expected the names of the columns of a CSV file as text");

  Header header{file, lines.number(), separator != 0 ? separator : find_separator(line), {}};
  if (const auto columns = std::count(line.begin(), line.end(), header.separator) + 1;
      static_cast<std::size_t>(columns) > kMostColumns)
    fail(fmt::format("has {} columns; expected at most {}", columns, kMostColumns));
  header.names = header_names(line, header.separator);
  const bool numbers_only =
      std::all_of(header.names.begin(), header.names.end(), [&header](const CsvName& name) {
        return number_in_field(name.full, header.separator).has_value();
      });
  if (numbers_only)
    fail(
        "contains numbers; expected the header with the names of the columns, without '#' in "
        "front");
  header.text = text;
  header.in_pairs = are_pairs(header.names);
  return header;
}

ColumnLabel label_of(const Header& header, std::size_t field) {
  ColumnLabel label{header.names[field].full, {}, {}, header.line};
  if (header.units.empty() || header.units[field].empty()) return label;
  label.unit = header.units[field];
  label.place = "row of units";
  label.line = header.units_line;
  return label;
}

/// Returns the index of the column with this name, given with or without its unit.
std::size_t find_column(const Header& header, const std::string& wanted) {
  const Location where{header.file, header.line, header.is_unnamed ? 1 : 0};
  if (const auto found = find_column(header.names, wanted)) {
    const bool is_time_of_pairs = header.in_pairs && found->index == 0;
    if (found->second && !is_time_of_pairs)
      throw InputError(where, fmt::format("columns {} and {} are both named '{}'; expected one",
                                          found->index + 1, *found->second + 1, wanted));
    return found->index;
  }
  if (header.is_unnamed)
    throw InputError(where,
                     fmt::format("contains numbers; expected the header with the names of the "
                                 "columns above them, without '#' in front and one for each, or "
                                 "a column by its number, \"1\" to \"{}\", instead of '{}'",
                                 header.names.size(), wanted));
  std::string message = unknown_name_message("column", wanted, short_names(header.names));
  if (header.names.size() == 1)
    message += fmt::format(
        "; {} was assumed to be the separator, expected one of ',', ';' or tab between the columns",
        separator_name(header.separator));
  throw InputError(where, message);
}

/// Whether a number with commas may have them between thousands: "12,345" but neither "0,345" nor
/// "1,5".
bool may_have_thousands(std::string_view text) {
  constexpr std::size_t kGroup = 3;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  while (!text.empty() && std::string_view("\" +-").find(text.front()) != std::string_view::npos)
    text.remove_prefix(1);
  while (!text.empty() && std::string_view("\" ").find(text.back()) != std::string_view::npos)
    text.remove_suffix(1);
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma > kGroup || text.front() == '0')
    return false;
  const std::string_view behind = text.substr(comma + 1);
  return behind.size() == kGroup && std::all_of(behind.begin(), behind.end(), is_digit);
}

// ---- Rows ----------------------------------------------------------------------------------

/// A column of the file, and the column of the table that it fills.
struct Wanted {
  std::size_t field;
  std::size_t target;
  bool is_time;
};

/// Reads rows one by one into a table, and keeps track of the position for its messages.
class RowReader {
 public:
  RowReader(const Header& header, const RecordRequest& request)
      : header_(header), request_(request) {
    for (std::size_t i = 0; i < request.columns.size(); ++i)
      wanted_.push_back(
          {find_column(header, request.columns[i]), i, request.columns[i] == request.time_column});
    has_pairs_ = header.in_pairs && std::any_of(wanted_.begin(), wanted_.end(),
                                                [](const Wanted& w) { return w.is_time; });
    values_.resize(wanted_.size());
    std::sort(wanted_.begin(), wanted_.end(),
              [](const Wanted& a, const Wanted& b) { return a.field < b.field; });
    table_.columns.resize(request.columns.size());
    table_.labels.resize(request.columns.size());
    for (const Wanted& wanted : wanted_)
      table_.labels[wanted.target] = label_of(header, wanted.field);
  }

  /// Reads a row. Returns false for text that is no row: the names again, or a remark.
  bool read(std::string_view line, long line_number) {
    if (rows_ == 0) first_line_ = line_number;
    if ((rows_ + 1) * wanted_.size() > kMostValues)
      throw InputError({header_.file, line_number},
                       fmt::format("more than {} numbers ({} rows of {} columns), the limit of one "
                                   "file; decimate the record, or split it into several files",
                                   kMostValues, rows_, wanted_.size()));
    if (read_plain(line, line_number)) {
      ++rows_;
      return true;
    }
    if (is_text(line)) return false;
    if (read_any(line, line_number)) ++rows_;
    return true;
  }

  /// Whether a line has a number in every wanted column.
  bool is_row(std::string_view line) const {
    std::size_t count = 0;
    auto next = wanted_.begin();
    CsvFields fields(line, header_.separator);
    for (CsvField field; fields.next(field); ++count) {
      // A .lvm has no text in the column of times that it leaves empty.
      if (header_.time && count < header_.names.size() && header_.names[count].full.empty() &&
          !field.text.empty())
        return false;
      for (; next != wanted_.end() && next->field == count; ++next)
        if (!number_in_field(field.text, header_.separator) &&
            !(next->is_time && time_stamp(field.text)))
          return false;
    }
    return next == wanted_.end();
  }

  /// Says that the names occurred again in a line, and rows follow.
  void note_header(long line_number) { repeated_header_ = line_number; }

  /// Reserves memory for all rows at once. Growing columns would temporarily need up to three times
  /// their memory, whereas unused capacity costs only addresses.
  void reserve(std::size_t rows) {
    for (auto& column : table_.columns)
      column.reserve(std::min(rows, kMostValues / table_.columns.size()));
  }

  std::size_t rows() const { return rows_; }
  std::size_t left_out() const { return left_out_; }
  const std::string& first_left_out() const { return first_left_out_; }

  /// Adds a warning if the file ends without a newline in the shortest number of its column.
  void judge_end() {
    if (last_line_ == 0 || !(last_length_ < shortest_length_) || rows_ < 2) return;
    table_.warning = fmt::format(
        "{}:{}: the file ends without a newline, and its last number, in column '{}', has {} "
        "character{} where all others have {} or more: it may have been cut off",
        header_.file, last_line_, shown(header_.names.back().full), last_length_,
        last_length_ == 1 ? "" : "s", shortest_length_);
  }

  /// Refuses numbers between quotes whose commas may all be between thousands: "1,500".
  /// @throws InputError  naming the first
  void judge_commas() const {
    if (header_.separator != ',' || comma_line_ == 0 || decimal_commas_) return;
    throw InputError(
        {header_.file, comma_line_},
        "the commas of this file may be decimal signs or between thousands: every one has three "
        "digits behind it; expected numbers without a sign between thousands, or decimal points");
  }

  /// Returns the table, after freeing capacity that is mostly unused.
  RecordTable take() {
    if (table_.warning.empty() && !clock_.doubt().empty())
      table_.warning = fmt::format("{}: {}", header_.file, clock_.doubt());
    if (left_out_ > 0)
      table_.left_out = fmt::format("{} row{} without a number: {}", left_out_,
                                    left_out_ == 1 ? "" : "s", first_left_out_);
    for (auto& column : table_.columns)
      if (column.size() < column.capacity() / 2) column.shrink_to_fit();
    return std::move(table_);
  }

 private:
  /// Reads a row as most loggers write it: wanted numbers are directly between separators, and no
  /// field begins with a quote. Returns false for any other row, whether right or wrong.
  bool read_plain(std::string_view line, long line_number) {
    if (header_.separator == ' ' || clock_.has_begun() || has_pairs_) return false;
    const char* at = line.data();
    const char* const end = at + line.size();
    std::size_t length = 0;  // length of the last wanted field
    auto next = wanted_.begin();
    auto value = values_.begin();
    for (std::size_t field = 0; field < header_.names.size(); ++field) {
      if (field > 0 && (at == end || *at++ != header_.separator)) return false;
      if (next == wanted_.end() || next->field != field) {
        if (at != end && (*at == '"' || *at == ' ')) return false;
        at = std::find(at, end, header_.separator);
        continue;
      }
      const auto [rest, error] = parse_double(at, end, *value);
      if (error != std::errc{} || !std::isfinite(*value)) return false;
      length = static_cast<std::size_t>(rest - at);
      const bool tells_sign = point_line_ == 0 || comma_line_ != 0;
      // note_decimal_sign() must see decimal points.
      if (tells_sign && std::find(at, rest, '.') != rest) return false;
      at = rest;
      for (const double number = *value; next != wanted_.end() && next->field == field; ++next) {
        *value = number;
        const auto& column = table_.columns[next->target];
        if (next->is_time && !column.empty() && !(number > column.back())) return false;
        ++value;
      }
    }
    if (at != end) return false;
    value = values_.begin();
    for (const Wanted& wanted : wanted_) table_.columns[wanted.target].push_back(*value++);
    if (wanted_.back().field + 1 == header_.names.size()) note_last_field(length, line_number);
    return true;
  }

  /// Reads any row, or reports what is wrong with it.
  /// @return  false if the row is left out because it lacks a number
  bool read_any(std::string_view line, long line_number) {
    std::size_t count = 0;
    auto next = wanted_.begin();
    std::optional<CsvField> bad;
    std::size_t bad_index = 0;
    CsvFields fields(line, header_.separator);
    std::string_view first_time;
    CsvField own_time;
    for (CsvField field; fields.next(field); ++count) {
      if (count == 0) first_time = field.text;
      if (count % 2 == 0) own_time = field;
      const bool has_other_time = has_pairs_ && next != wanted_.end() && next->field == count &&
                                  own_time.text != first_time && count % 2 == 1;
      if (has_other_time) fail_on_pair(line, line_number, own_time, count, first_time);
      for (; next != wanted_.end() && next->field == count; ++next) {
        auto value = number_in_field(field.text, header_.separator);
        const bool is_stamp = next->is_time && !value;
        if (is_stamp) value = seconds_of_stamp(field.text, next->target);
        if (next->is_time && clock_.has_begun() && !is_stamp) value.reset();
        if (!value && !bad) {
          bad = field;
          bad_index = count;
        }
        if (!value || bad) continue;
        if (!is_stamp) note_decimal_sign(line, line_number, field);
        if (count + 1 == header_.names.size()) note_last_field(field.text.size(), line_number);
        auto& column = table_.columns[next->target];
        if (!column.empty() && next->is_time && !(*value > column.back()))
          fail_on_time(line, line_number, field, *value, column.back());
        column.push_back(*value);
      }
    }
    // A comment that a row omits is not a number, so a request for that column is an error.
    const bool lacks_last =
        header_.last_may_lack && count + 1 == header_.names.size() && next == wanted_.end();
    if (line_number == first_line_) rows_end_empty_ = ends_empty(line, count);
    const bool ends = rows_end_empty_ && ends_empty(line, count);
    if (count != header_.names.size() && !lacks_last && !ends)
      fail_on_count(line, line_number, count);
    if (!bad) return true;
    if (!request_.leaves_out_rows || is_text_only(line))
      fail_on_number(line, line_number, *bad, bad_index);
    for (auto& column : table_.columns) column.resize(rows_);
    if (left_out_++ == 0)
      first_left_out_ = fmt::format("line {} has '{}' in column '{}'", line_number,
                                    shown(bad->text), shown(header_.names[bad_index].full));
    return false;
  }

  /// Whether a row has a separator behind its last column, which the header does not have.
  bool ends_empty(std::string_view line, std::size_t count) const {
    return count == header_.names.size() + 1 && header_.separator != ' ' &&
           line.find_last_not_of(" \t\r") != std::string_view::npos &&
           line.substr(line.rfind(header_.separator) + 1).find_first_not_of(" \t") ==
               std::string_view::npos;
  }

  /// Returns the seconds since the first time stamp. Numbers and stamps do not mix.
  std::optional<double> seconds_of_stamp(std::string_view text, std::size_t target) {
    const auto stamp = time_stamp(text);
    if (!stamp || (rows_ > 0 && !clock_.has_begun())) return std::nullopt;
    if (!clock_.has_begun()) {
      table_.labels[target].unit = "s";
      table_.labels[target].place = "time stamps";
    }
    return clock_.seconds(*stamp);
  }

  InputError error(std::string_view line, long line_number, std::size_t byte,
                   const std::string& message) const {
    return InputError({header_.file, line_number, character_column(line, byte)}, message);
  }

  [[noreturn]] void fail_on_time(std::string_view line, long line_number, const CsvField& field,
                                 double now, double before) const {
    if (repeated_header_ != 0)
      throw InputError({header_.file, repeated_header_, 1},
                       fmt::format("the header occurs again, and time '{}' does not go on: {} "
                                   "comes after {}. A second recording begins here; expected one "
                                   "in each file",
                                   request_.time_column, now, before));
    throw error(line, line_number, field.begin,
                fmt::format("time '{}' does not increase: {} comes after {}; expected a larger "
                            "value in each row",
                            request_.time_column, now, before));
  }

  [[noreturn]] void fail_on_pair(std::string_view line, long line_number, const CsvField& own,
                                 std::size_t index, std::string_view first) const {
    throw error(line, line_number, own.begin,
                fmt::format("the time of '{}' is '{}', that of '{}' is '{}'; expected the same "
                            "times in each pair of columns: export the signals at one sample time, "
                            "or those of each sample time to a file of their own",
                            shown(header_.names[index].full), shown(own.text),
                            shown(header_.names[1].full), shown(first)));
  }

  [[noreturn]] void fail_on_count(std::string_view line, long line_number,
                                  std::size_t count) const {
    const std::size_t expected = header_.names.size();
    std::size_t byte = line.size();
    CsvFields fields(line, header_.separator);
    CsvField field;
    for (std::size_t i = 0; i <= expected && fields.next(field); ++i)
      if (i == expected) byte = field.begin;
    std::string message =
        fmt::format("{} columns; expected {} as in the header (line {}), separated by {}", count,
                    expected, header_.line, separator_name(header_.separator));
    if (is_comment(line))
      message += "; comments are accepted before the header only";
    else if (count == expected + 1 && field.text.empty() && line.back() == header_.separator)
      message += "; the line ends with a separator that the header does not have";
    else if (count > expected && header_.separator == ',')
      message +=
          "; decimal commas are a likely cause: write decimal points, or separate the "
          "columns by ';'";
    throw error(line, line_number, byte, message);
  }

  [[noreturn]] void fail_on_number(std::string_view line, long line_number, const CsvField& field,
                                   std::size_t index) const {
    const std::string& name = header_.names[index].full;
    if (line_number == first_line_ && is_text_only(line))
      throw error(line, line_number, field.begin,
                  fmt::format("the first row has no numbers ('{}' in column '{}') and looks like a "
                              "second header line; expected numbers. Remove such a line; units "
                              "follow the names (\"x [mm]\") or are in the campaign file",
                              shown(field.text), shown(name)));
    if (header_name(field.text).full == name)
      throw error(line, line_number, field.begin,
                  fmt::format("the header occurs again ('{}') in other words than in line {}: a "
                              "second recording begins here; expected one in each file",
                              shown(name), header_.line));
    if (field.text.empty())
      throw error(line, line_number, field.begin,
                  fmt::format("column '{}' is empty; expected a number", shown(name)));
    throw error(
        line, line_number, field.begin,
        fmt::format("'{}' in column '{}' is not a finite number; expected one such as "
                    "-1.5e-3{}",
                    shown(field.text), shown(name), header_.separator == ',' ? "" : " or -1,5e-3"));
  }

  /// Refuses a file with both decimal commas and decimal points, since "1.234" could be a thousand
  /// times larger.
  void note_decimal_sign(std::string_view line, long line_number, const CsvField& field) {
    const bool has_comma = field.text.find(',') != std::string_view::npos;
    const bool has_point = field.text.find('.') != std::string_view::npos;
    decimal_commas_ = decimal_commas_ || (has_comma && !may_have_thousands(field.text));
    if (has_comma && comma_line_ == 0) comma_line_ = line_number;
    if (has_point && point_line_ == 0) point_line_ = line_number;
    if ((!has_comma && !has_point) || comma_line_ == 0 || point_line_ == 0) return;
    throw error(line, line_number, field.begin,
                fmt::format("'{}' has a decimal {}, but line {} has a decimal {}; expected one of "
                            "them in the whole file, and no sign between thousands",
                            shown(field.text), has_comma ? "comma" : "point",
                            has_comma ? point_line_ : comma_line_, has_comma ? "point" : "comma"));
  }

  /// Records the length of the number at the end of the last line, and the shortest one before it.
  void note_last_field(std::size_t length, long line_number) {
    if (last_line_ != 0) shortest_length_ = std::min(shortest_length_, last_length_);
    last_length_ = length;
    last_line_ = line_number;
  }

  bool is_text(std::string_view line) const {
    if (rows_ == 0 || header_.is_unnamed || is_comment(line)) return false;
    if (line == header_.text) return true;
    const auto fields =
        static_cast<std::size_t>(std::count(line.begin(), line.end(), header_.separator) + 1);
    return header_.separator != ' ' && fields < header_.names.size() && is_text_only(line);
  }

  bool is_text_only(std::string_view line) const {
    bool any = false;
    CsvFields fields(line, header_.separator);
    for (CsvField field; fields.next(field);) {
      if (number_in_field(field.text, header_.separator)) return false;
      any = any || !field.text.empty();
    }
    return any;
  }

  const Header& header_;
  const RecordRequest& request_;
  std::vector<Wanted> wanted_;
  std::vector<double> values_;  ///< values of the row being read, in the order of wanted_
  RecordTable table_;
  long repeated_header_ = 0;  ///< line of the last header but the first; 0: none
  bool has_pairs_ = false;    ///< the times of all pairs must agree
  std::size_t rows_ = 0;
  long first_line_ = 0;  ///< line of the first row
  StampClock clock_;
  bool rows_end_empty_ = false;  ///< the first row has a separator behind its last column
  long comma_line_ = 0;          ///< line of the first decimal comma; 0: none
  bool decimal_commas_ = false;  ///< some comma cannot be between thousands
  long point_line_ = 0;          ///< line of the first decimal point; 0: none
  long last_line_ = 0;           ///< line of the last number; 0: the last column is not wanted
  std::size_t left_out_ = 0;     ///< number of rows that lack a number
  std::string first_left_out_;   ///< the first of them, in words
  std::size_t last_length_ = 0;
  std::size_t shortest_length_ = std::numeric_limits<std::size_t>::max();
};

/// Returns a request without the times that no column of the file contains. It has one column at
/// least.
RecordRequest without_lvm_time(RecordRequest request, const Header& header) {
  std::erase(request.columns, kLvmTime);
  if (request.time_column == kLvmTime) request.time_column.clear();
  const std::size_t first = header.names.front().full.empty() ? 1 : 0;
  if (request.columns.empty()) request.columns.push_back(header.names.at(first).full);
  return request;
}

/// Inserts the times of samples at equal distances where they were requested.
/// @throws InputError  if the distance is too small for a double
void insert_lvm_time(const RecordRequest& request, const Header& header, RecordTable& table) {
  const std::size_t rows = table.columns.front().size();
  std::vector<double> time_s(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    time_s[i] = header.time->start_s + header.time->step_s * static_cast<double>(i);
    if (!std::isfinite(time_s[i]) || (i > 0 && !(time_s[i] > time_s[i - 1])))
      throw InputError({header.file, header.line},
                       fmt::format("Delta_X is {} s, with X0 = {} s: the times do not increase; "
                                   "expected a positive sample interval",
                                   header.time->step_s, header.time->start_s));
  }
  RecordTable with_times = std::move(table);
  std::vector<std::vector<double>> columns;
  std::vector<ColumnLabel> labels;
  std::size_t next = 0;
  for (const std::string& name : request.columns) {
    const bool is_time = name == kLvmTime;
    columns.push_back(is_time ? time_s : std::move(with_times.columns[next]));
    labels.push_back(is_time ? ColumnLabel{std::string(kLvmTime), "s", "Delta_X", header.line}
                             : with_times.labels[next]);
    if (!is_time) ++next;
  }
  table = std::move(with_times);
  table.columns = std::move(columns);
  table.labels = std::move(labels);
}

/// Lines between rows: empty ones, text, and the names of the columns again. Some programs repeat
/// the names on each page or above each block; others write a summary behind the data.
class Interruption {
 public:
  explicit Interruption(const Header& header) : header_(header) {}

  bool is_open() const { return first_line_ != 0; }

  void add(std::string_view line, long number) {
    if (first_line_ == 0) first_line_ = number;
    const bool below_names = names_line_ != 0 && number == names_line_ + 1;
    if (below_names && !header_.units_text.empty() && line != header_.units_text)
      throw InputError({header_.file, number, 1},
                       fmt::format("the header occurs again, but the row below it is not that of "
                                   "line {}; expected the same units in the whole file",
                                   header_.units_line));
    if (is_blank(line)) return;
    if (text_line_ == 0) {
      text_line_ = number;
      text_ = line;
    }
    if (!header_.text.empty() && line == header_.text) names_line_ = number;
  }

  /// Ends the lines at a row, which goes on with the recording if the names were repeated.
  /// @return  the line of the names
  /// @throws InputError  if they were not
  long end_at(long row) {
    if (text_line_ == 0)
      throw InputError({header_.file, first_line_, 1},
                       fmt::format("an empty line inside the data, which continue in line {}; "
                                   "expected a row of {} columns",
                                   row, header_.names.size()));
    if (names_line_ == 0 || header_.time)
      throw InputError({header_.file, text_line_, 1},
                       fmt::format("'{}' inside the data, which continue in line {}; expected rows "
                                   "of {} columns. Save each block of data to a file of its own",
                                   shown(text_), row, header_.names.size()));
    const long names = names_line_;
    if (repeats_++ == 0) first_repeat_ = names;
    first_line_ = text_line_ = names_line_ = 0;
    return names;
  }

  /// Says what was left out between the rows and behind them; empty if nothing was.
  std::string warning() const {
    std::string text;
    if (repeats_ > 0)
      text = fmt::format(
          "{}:{}: the header occurs again{}; its times go on, so that all rows are "
          "one recording",
          header_.file, first_repeat_,
          repeats_ > 1 ? fmt::format(", {} times in all", repeats_) : "");
    if (text_line_ == 0) return text;
    return text + fmt::format(
                      "{}{}:{}: not read: '{}' and all lines behind it, which follow the "
                      "last row",
                      text.empty() ? "" : "; ", header_.file, text_line_, shown(text_));
  }

 private:
  const Header& header_;
  long first_line_ = 0;  ///< 0: the last line was a row
  long text_line_ = 0;   ///< first line that is not empty
  std::string text_;
  long names_line_ = 0;
  long repeats_ = 0;
  long first_repeat_ = 0;
};

/// Returns an upper bound on the number of rows in a file: a field takes at least two bytes,
/// including its separator.
std::size_t most_rows(const std::filesystem::path& path, const Header& header) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return kMostValues;  // a pipe has no size
  return static_cast<std::size_t>(bytes / (2 * header.names.size()) + 1);
}

}  // namespace

RecordTable load_csv_record(const std::filesystem::path& path, const RecordRequest& request) {
  require_time_column(request);
  CsvLines file(path, kMostCsvBytes);
  HeadedLines lines(file);
  const Header header = read_header(lines, path.string(), request.separator);
  const RecordRequest in_rows = header.time ? without_lvm_time(request, header) : request;
  RowReader reader(header, in_rows);
  reader.reserve(most_rows(path, header));
  Interruption between(header);
  while (const char* text = lines.next()) {
    const std::string_view line = text;
    if (is_blank(line) || (between.is_open() && !reader.is_row(line))) {
      between.add(line, lines.number());
      continue;
    }
    if (between.is_open()) reader.note_header(between.end_at(lines.number()));
    if (!reader.read(line, lines.number())) between.add(line, lines.number());
  }
  if (reader.rows() == 0)
    throw InputError(
        {header.file, header.line},
        (reader.left_out() > 0 ? "no row has a number in every column: " + reader.first_left_out()
                               : std::string("no rows after the header")) +
            "; expected at least one row of numbers");
  if (file.ends_without_newline() && !between.is_open()) reader.judge_end();
  reader.judge_commas();
  RecordTable table = reader.take();
  if (const std::string left_out = between.warning(); !left_out.empty())
    table.warning += (table.warning.empty() ? "" : "; ") + left_out;
  if (header.time) insert_lvm_time(request, header, table);
  return table;
}

std::vector<RecordColumn> csv_record_columns(const std::filesystem::path& path) {
  CsvLines file(path, kMostCsvBytes);
  HeadedLines lines(file);
  const Header header = read_header(lines, path.string(), 0);
  std::vector<RecordColumn> columns;
  if (header.time) columns.push_back({std::string(kLvmTime), "s", true});
  for (std::size_t i = 0; i < header.names.size(); ++i) {
    const bool is_time = header.in_pairs && i % 2 == 0;
    if (header.time && header.names[i].full.empty()) continue;  // the X_Value without numbers
    if (is_time && i > 0) continue;  // load_csv_record() compares it with the first
    columns.push_back(
        {header.names[i].full, header.units.empty() ? std::string() : header.units[i], is_time});
  }
  return columns;
}

}  // namespace rigcal::datasets
