#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/csv/csv_text.hpp"

namespace rigcal::datasets {

/// Where names, units and numbers stand in a text of columns.
struct CsvLayout {
  std::size_t header = 0;  ///< line of the names, from 0
  std::size_t data = 0;    ///< the first row of numbers
  char separator = ',';
  std::vector<CsvName> names;
  bool last_may_lack = false;      ///< rows may end before the last column, a comment
  std::vector<std::string> units;  ///< of a row between the two, one per name; empty: no such row
};

/// Finds them in a text whose first line is not simply its header: below lines of text (loggers,
/// LabVIEW's .lvm, dSPACE), in columns between blanks, with a row of units, or with the names in a
/// comment right above the numbers. The numbers begin where two lines (or the last one) hold as
/// many fields, all of them numbers; the names stand right above them, one for each, none a number.
///
/// @param lines      how the text begins, without line ends
/// @param is_whole   whether that is all of it
/// @param separator  0: any of tab, ';', ',' and blanks
std::optional<CsvLayout> find_layout(std::span<const std::string> lines, bool is_whole,
                                     char separator);

/// Whether a line is a row of numbers under a header of so many names.
bool is_row_of_numbers(std::string_view line, char separator, std::size_t names);

}  // namespace rigcal::datasets
