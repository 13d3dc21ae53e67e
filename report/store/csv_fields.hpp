#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rigcal::report {

/// Shortest text that reads back to the same bits; empty if the value is not a number.
std::string csv_number(double value);
std::string csv_number(const std::optional<double>& value);

/// A text as a CSV field: in quotes if it has a comma, a quote or a line end; with "'" in front if
/// a spreadsheet would run it as a formula (text that begins with = + - @, a tab or a carriage
/// return and is no number).
std::string csv_text(const std::string& text);

/// A text as a line that begins with "#".
std::string csv_comment(std::string text);

/// Fields as a line of CSV, its end included.
std::string csv_row(const std::vector<std::string>& fields);

}  // namespace rigcal::report
