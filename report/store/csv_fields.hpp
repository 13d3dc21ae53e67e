#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal::report {

/// Returns the shortest text that is read back as the same double; empty if the value is not
/// finite.
std::string csv_number(double value);

/// Writes a text as a CSV field. Quotes it if it contains a comma, a quote or a line end. Puts "'"
/// in front if a spreadsheet would run it as a formula (a text other than a number that begins with
/// = + - @, a tab or a carriage return).
std::string csv_text(const std::string& text);

/// Writes a text as one comment line, which begins with "#".
std::string csv_comment(std::string text);

/// Writes the comment that comes first in the tables of an incomplete result:
/// "# status: failed: why".
std::string csv_status(std::string_view status, const std::vector<std::string>& reasons);

/// Joins fields to a CSV line, including the line end.
std::string csv_row(const std::vector<std::string>& fields);

}  // namespace rigcal::report
