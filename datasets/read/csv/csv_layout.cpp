#include "datasets/read/csv/csv_layout.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "datasets/read/csv/time_stamp.hpp"
#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::array kSeparators{'\t', ';', ',', ' '};
constexpr std::size_t kFewestColumns = 2;

std::string_view trimmed_line(std::string_view text, std::string_view blanks = " \t") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool is_plain_text(std::string_view line) {
  return std::none_of(line.begin(), line.end(),
                      [](char c) { return c >= 0 && c < ' ' && c != '\t'; });
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  CsvFields walk(line, separator);
  for (CsvField field; walk.next(field);) fields.push_back(field.text);
  return fields;
}

bool is_number(std::string_view text, char separator) {
  return number_in_field(text, separator).has_value();
}

/// Whether a text may be in a row of numbers: a clock counts.
bool is_datum(std::string_view text, char separator) {
  return is_number(text, separator) || time_stamp(text) || is_date(text);
}

/// Whether a text may precede a row. dSPACE writes "trace_values" before its first row, and nothing
/// before the others.
bool is_label(std::string_view text) { return text.empty() || text == "trace_values"; }

/// Returns the number of fields in a row of numbers; 0 for any other line. The first field may be a
/// label. An empty last field is an unused comment and does not count.
std::size_t width_of_row(std::string_view line, char separator) {
  if (!is_plain_text(line)) return 0;
  const auto fields = fields_of(line, separator);
  std::size_t begin = 0;
  std::size_t end = fields.size();
  if (end > 0 && is_label(fields.front())) ++begin;
  if (end > begin && fields[end - 1].empty()) --end;
  if (end < begin + kFewestColumns) return 0;
  const bool numbers =
      std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(begin),
                  fields.begin() + static_cast<std::ptrdiff_t>(end),
                  [separator](std::string_view text) { return is_datum(text, separator); });
  return numbers ? end : 0;
}

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_unit_text(std::string_view text) {
  if (text.size() > 1 && (text.front() == '[' || text.front() == '('))
    text = text.substr(1, text.size() - 2);
  // What loggers write where a column has no unit.
  constexpr std::array<std::string_view, 8> kNone{"",    "-",    "%",      "1",
                                                  "n/a", "none", "counts", "raw"};
  return std::find(kNone.begin(), kNone.end(), in_lower_case(text)) != kNone.end() ||
         !unit_of_text(text).empty();
}

/// Returns the fields of a row of units in brackets, each on its own: "(s)", "(mm)".
std::vector<CsvName> each_in_brackets(std::string_view line) {
  std::vector<CsvName> names;
  for (const std::string_view field : fields_of(line, ' ')) names.push_back(header_name(field));
  return names;
}

/// Returns the names in a line, if there is one for each field of a row and at most one more for
/// comments. The line itself may be a comment.
std::vector<CsvName> names_in(std::string_view line, char separator, std::size_t width) {
  if (!is_plain_text(line)) return {};
  // Tabs at either end belong to columns without a name.
  line = trimmed_line(line, separator == '\t' ? " " : " \t");
  while (line.starts_with('#') || line.starts_with('%')) line = line.substr(1);
  if (separator == ' ' || line.empty()) line = trimmed_line(line);
  const bool in_brackets = separator == ' ' && (line.starts_with('(') || line.starts_with('['));
  std::vector<CsvName> names = in_brackets ? each_in_brackets(line) : header_names(line, separator);
  const bool has_comment =
      names.size() == width + 1 && (names.back().full == "Comment" || names.back().full.empty());
  const bool any = std::any_of(names.begin(), names.end(),
                               [](const CsvName& name) { return !name.full.empty(); });
  const bool numbers = std::any_of(names.begin(), names.end(), [separator](const CsvName& name) {
    return is_number(name.full, separator);
  });
  // "Column 3: displacement" between blanks are not three names.
  const bool sentence =
      separator == ' ' && std::any_of(names.begin(), names.end(),
                                      [](const CsvName& name) { return name.full.ends_with(':'); });
  if ((names.size() != width && !has_comment) || !any || numbers || sentence) return {};
  return names;
}

bool is_label_of_units(std::string_view text) {
  std::string label = in_lower_case(text);
  if (label.ends_with(':')) label.pop_back();
  constexpr std::array<std::string_view, 5> kLabels{"unit", "units", "einheit", "einheiten",
                                                    "trace_units"};
  return std::find(kLabels.begin(), kLabels.end(), label) != kLabels.end();
}

/// Whether a row consists of units. Its first field may be a label such as "units".
bool are_units(const std::vector<CsvName>& names) {
  const bool labelled = names.size() > 1 && is_label_of_units(names.front().full);
  return std::all_of(names.begin() + (labelled ? 1 : 0), names.end(),
                     [](const CsvName& name) { return is_unit_text(name.full); });
}

/// Returns the nearest line above that is not blank, or lines.size() if there is none.
std::size_t line_above(std::span<const std::string> lines, std::size_t line) {
  while (line > 0)
    if (!trimmed_line(lines[--line]).empty()) return line;
  return lines.size();
}

/// A line of names or units, and its position.
struct NamedLine {
  std::size_t line = 0;
  std::vector<CsvName> names;  ///< empty if the line has no names
};

/// Whether a line describes the columns and names none: "Rate: 250 Hz" for each.
bool are_settings(const std::vector<CsvName>& names) {
  return std::all_of(names.begin(), names.end(), [](const CsvName& name) {
    return name.full.empty() || name.full.find(": ") != std::string::npos;
  });
}

NamedLine names_above(std::span<const std::string> lines, std::size_t line, char separator,
                      std::size_t width) {
  for (std::size_t above = line_above(lines, line); above < lines.size();
       above = line_above(lines, above)) {
    NamedLine found{above, names_in(lines[above], separator, width)};
    if (found.names.empty() || !are_settings(found.names)) return found;
  }
  return {};
}

/// Finds the names where each value has a column of times before it and the lines above have pairs
/// of a key and a value instead, as TwinCAT Scope writes them: "Name", "ActPos", "Name", "ActPres".
std::optional<CsvLayout> layout_of_pairs(std::span<const std::string> lines, std::size_t data,
                                         char separator, std::size_t width) {
  if (width < 4 || width % 2 != 0) return std::nullopt;
  std::optional<std::size_t> names_line;
  std::vector<std::string_view> units;
  std::size_t units_line = 0;
  for (std::size_t above = line_above(lines, data); above < lines.size();
       above = line_above(lines, above)) {
    const auto fields = fields_of(lines[above], separator);
    bool alternate = fields.size() + 1 >= width && !fields.front().empty();
    for (std::size_t i = 2; alternate && i < width; i += 2) alternate = fields[i] == fields.front();
    if (!alternate) break;
    if (fields.front() == "Name") names_line = above;
    if (fields.front() != "Unit") continue;
    units = fields;
    units_line = above;
  }
  if (!names_line) return std::nullopt;
  const auto names = header_names(lines[*names_line], separator);
  CsvLayout layout{*names_line, data, separator, {}, false, {}, units_line};
  // Ticks of 100 ns since 1601, or milliseconds since the beginning.
  constexpr double kTicksOfACentury = 3e16;
  const double first =
      number_in_field(fields_of(lines[data], separator).front(), separator).value_or(0);
  const std::string_view time_unit = first > kTicksOfACentury ? "100 ns" : "ms";
  for (std::size_t i = 1; i < width; i += 2) {
    layout.names.push_back({"Time", "Time"});
    layout.names.push_back(i < names.size() ? names[i] : CsvName());
    layout.units.emplace_back(time_unit);
    layout.units.push_back(i < units.size() ? unit_of_text(units[i]) : std::string());
  }
  if (units.empty()) layout.units_line = *names_line;
  return layout;
}

/// Finds names and units above the first row of numbers. There may be a line of descriptions, such
/// as the sensors, between the units and the numbers.
std::optional<CsvLayout> layout_above(std::span<const std::string> lines, std::size_t data,
                                      char separator, std::size_t width) {
  const NamedLine first = names_above(lines, data, separator, width);
  if (first.names.empty()) return std::nullopt;
  const NamedLine second = names_above(lines, first.line, separator, width);
  NamedLine names = first;
  NamedLine units;
  if (are_units(first.names)) {
    units = first;
    names = second;
  } else if (!second.names.empty() && are_units(second.names)) {
    units = second;
    names = names_above(lines, second.line, separator, width);
  }
  if (names.names.size() != units.names.size() || are_units(names.names)) {
    names = first;
    units = {};
  }
  CsvLayout layout{names.line, data, separator, names.names, false, {}, 0};
  layout.last_may_lack = layout.names.size() > width;
  for (const CsvName& unit : units.names) {
    std::string_view text = is_label_of_units(unit.full) ? std::string_view() : unit.full;
    if (text.size() > 1 && (text.front() == '[' || text.front() == '('))
      text = text.substr(1, text.size() - 2);
    layout.units.emplace_back(text);
  }
  if (!units.names.empty()) layout.units_line = units.line;
  return layout;
}

struct FirstRow {
  std::size_t line = 0;
  std::size_t width = 0;
};

/// Finds the first row of numbers that the next row, or the end of the text, confirms.
std::optional<FirstRow> first_rows(std::span<const std::string> lines, bool is_whole,
                                   char separator) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t width = width_of_row(lines[i], separator);
    if (width == 0) continue;
    std::size_t next = i + 1;
    while (next < lines.size() && trimmed_line(lines[next]).empty()) ++next;
    const bool goes_on =
        next < lines.size() ? width_of_row(lines[next], separator) == width : is_whole;
    if (goes_on) return FirstRow{i, width};
  }
  return std::nullopt;
}

}  // namespace

bool is_row_of_numbers(std::string_view line, char separator, std::size_t names) {
  const auto fields = fields_of(line, separator);
  return fields.size() == names &&
         std::all_of(fields.begin(), fields.end(),
                     [separator](std::string_view text) { return is_datum(text, separator); });
}

std::optional<CsvLayout> find_layout(std::span<const std::string> lines, bool is_whole,
                                     char separator) {
  for (const char each : kSeparators) {
    if (separator != 0 && separator != each) continue;
    const auto rows = first_rows(lines, is_whole, each);
    if (!rows) continue;
    if (auto layout = layout_of_pairs(lines, rows->line, each, rows->width)) return layout;
    if (auto layout = layout_above(lines, rows->line, each, rows->width)) return layout;
  }
  return std::nullopt;
}

std::optional<CsvLayout> find_unnamed(std::span<const std::string> lines, bool is_whole,
                                      char separator) {
  for (const char each : kSeparators) {
    if (separator != 0 && separator != each) continue;
    const auto rows = first_rows(lines, is_whole, each);
    if (!rows) continue;
    CsvLayout layout;
    layout.header = rows->line;
    layout.data = rows->line;
    layout.separator = each;
    for (std::size_t i = 1; i <= rows->width; ++i)
      layout.names.push_back({std::to_string(i), std::to_string(i)});
    return layout;
  }
  return std::nullopt;
}

}  // namespace rigcal::datasets
