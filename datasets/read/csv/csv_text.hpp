#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::datasets {

/// A field of a line: its text without surrounding spaces, and where that text begins.
struct CsvField {
  std::string_view text;
  std::size_t begin = 0;  ///< in bytes from the start of the line
};

/// Iterates over the fields of a line. A separator between double quotes is text, and the quotes
/// are kept. If the separator is a space, any number of spaces and tabs separates two fields.
class CsvFields {
 public:
  CsvFields(std::string_view line, char separator) : line_(line), separator_(separator) {}
  /// Returns false after the last field. An empty line has one empty field.
  bool next(CsvField& field);

 private:
  bool next_between_blanks(CsvField& field);

  std::string_view line_;
  char separator_;
  std::size_t position_ = 0;
  bool done_ = false;
};

/// Name of a column, as in the header (without quotes) and without its unit.
struct CsvName {
  std::string full;   ///< "x [mm]"
  std::string plain;  ///< "x"
};

/// Extracts the name from a field of a header.
CsvName header_name(std::string_view field);

/// Returns names by which columns can be requested. They omit the unit where that is unambiguous.
std::vector<std::string> short_names(const std::vector<CsvName>& names);

/// The column that matches a name, given with or without its unit. If the name is ambiguous,
/// `second` is another column that matches.
struct FoundColumn {
  std::size_t index = 0;
  std::optional<std::size_t> second;
};
std::optional<FoundColumn> find_column(const std::vector<CsvName>& names,
                                       const std::string& wanted);

/// Finds the separator used in a header: tab, else ';', else ','.
char find_separator(std::string_view header);

/// Returns the names of all columns in a header.
std::vector<CsvName> header_names(std::string_view header, char separator);

/// Returns the number in a field, or std::nullopt for any other text. The locale has no influence.
/// It may be between double quotes, as some programs write every field. Rejects "inf", "nan",
/// numbers beyond the range of a double, and thousands separators.
///
/// @param decimal_comma  whether to accept "1,5", too
std::optional<double> csv_number(std::string_view text, bool decimal_comma);

/// Returns the number in a field of a file of columns. A comma is its decimal sign unless it
/// separates the columns; between double quotes it is in any file: "1,5". The exponent may be that
/// of Fortran: "1.5D-03".
std::optional<double> number_in_field(std::string_view text, char separator);

/// Shortens a text for a message, and replaces unprintable characters with '?'.
std::string shown(std::string_view text);

/// Converts the position of a byte in a UTF-8 line to that of its character, counted from 1.
long character_column(std::string_view line, std::size_t byte);

}  // namespace rigcal::datasets
