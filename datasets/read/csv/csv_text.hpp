#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::datasets {

/// A field of a line: its text without surrounding blanks, and where that begins.
struct CsvField {
  std::string_view text;
  std::size_t begin = 0;  ///< in bytes from the start of the line
};

/// Walks over the fields of a line. A separator between double quotes is text, and the quotes stay
/// part of it. A blank as separator means any number of blanks and tabs.
class CsvFields {
 public:
  CsvFields(std::string_view line, char separator) : line_(line), separator_(separator) {}
  /// False after the last field. An empty line has one empty field.
  bool next(CsvField& field);

 private:
  bool next_between_blanks(CsvField& field);

  std::string_view line_;
  char separator_;
  std::size_t position_ = 0;
  bool done_ = false;
};

/// Name of a column: as in the header (without quotes), and without its unit.
struct CsvName {
  std::string full;   ///< "x [mm]"
  std::string plain;  ///< "x"
};

/// Name in a field of a header.
CsvName header_name(std::string_view field);

/// Names for requesting columns: without unit if that is unambiguous.
std::vector<std::string> short_names(const std::vector<CsvName>& names);

/// The column of this name, with its unit or without; `second` is another of the same name, for
/// which it is not clear which is meant.
struct FoundColumn {
  std::size_t index = 0;
  std::optional<std::size_t> second;
};
std::optional<FoundColumn> find_column(const std::vector<CsvName>& names,
                                       const std::string& wanted);

/// The separator a header was written with: tab, else ';', else ','.
char find_separator(std::string_view header);

/// Names of all columns of a header.
std::vector<CsvName> header_names(std::string_view header, char separator);

/// The number in a field, or nothing for any other text. Locale-independent; "inf", "nan", numbers
/// beyond the range of a double, and a thousands separator are no numbers here.
///
/// @param decimal_comma  whether "1,5" counts, too
std::optional<double> csv_number(std::string_view text, bool decimal_comma);

/// Text for a message: shortened, with '?' for unprintable characters.
std::string shown(std::string_view text);

/// Character position, from 1, of a byte of a UTF-8 line.
long character_column(std::string_view line, std::size_t byte);

}  // namespace rigcal::datasets
