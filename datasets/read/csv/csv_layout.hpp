#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/csv/csv_text.hpp"

namespace rigcal::datasets {

/// Positions of names, units and numbers in a text with columns.
struct CsvLayout {
  std::size_t header = 0;  ///< line that contains the names, from 0
  std::size_t data = 0;    ///< first line that contains numbers
  char separator = ',';
  std::vector<CsvName> names;
  bool last_may_lack = false;      ///< the last column is a comment that rows may omit
  std::vector<std::string> units;  ///< one per name; empty without a row of units
  std::size_t units_line = 0;      ///< line that contains the units, if there are any
};

/// Finds the layout of a text that does not simply begin with its header. Names may follow lines of
/// text (loggers, LabVIEW's .lvm, dSPACE), be separated by spaces, have a row of units below them,
/// or be in a comment directly above the numbers. The numbers begin at the first of two lines (or
/// at the last line) that have the same number of fields, all of them numbers. The names are
/// directly above them, one per field, and none of them is a number. Lines of settings ("Rate: 250
/// Hz" in each field) may be between both. TwinCAT Scope has pairs of time and value, with pairs of
/// a key and a value above them; all their times are then named "Time".
///
/// @param lines  first lines of the text, without line ends
/// @param is_whole  whether `lines` is the whole text
/// @param separator  0: any of tab, ';', ',' and spaces
std::optional<CsvLayout> find_layout(std::span<const std::string> lines, bool is_whole,
                                     char separator);

/// Finds columns of numbers that no line names: two or more in each row, from the first of two
/// lines on as find_layout() has them. They get the names "1", "2" and so on.
std::optional<CsvLayout> find_unnamed(std::span<const std::string> lines, bool is_whole,
                                      char separator);

/// Whether a line has one number for each of `names` columns.
bool is_row_of_numbers(std::string_view line, char separator, std::size_t names);

}  // namespace rigcal::datasets
