#include "report/store/csv_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace rigcal::report {
namespace {

/// Whether a spreadsheet would run a text as a formula because of its first character. Numbers are
/// not formulas.
bool is_formula(const std::string& text) {
  if (text.empty() || std::string_view("=+-@\t\r").find(text.front()) == std::string_view::npos)
    return false;
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  const char* end = text.data() + text.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  return error != std::errc{} || rest != end;
}

}  // namespace

std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string csv_text(const std::string& text) {
  const std::string safe = is_formula(text) ? "'" + text : text;
  if (safe.find_first_of(",\"\r\n") == std::string::npos) return safe;
  std::string result = "\"";
  for (const char c : safe) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

std::string csv_comment(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return "# " + text + "\n";
}

std::string csv_status(std::string_view status, const std::vector<std::string>& reasons) {
  return csv_comment(fmt::format("status: {}: {}", status, fmt::join(reasons, "; ")));
}

std::string csv_row(const std::vector<std::string>& fields) {
  return fmt::format("{}\n", fmt::join(fields, ","));
}

}  // namespace rigcal::report
