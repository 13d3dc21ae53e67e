#include "datasets/read/csv/lvm_header.hpp"

#include <algorithm>

#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

/// Fields of a line of the header, such as "Delta_X", "0.005", "0.005".
struct LvmLine {
  std::size_t line = 0;
  std::vector<std::string_view> fields;
};

/// Finds the last line with a key, which is that of the columns below it.
std::optional<LvmLine> lvm_line(std::span<const std::string> lines, char separator,
                                std::string_view key) {
  for (std::size_t i = lines.size(); i-- > 0;) {
    LvmLine found{i, {}};
    CsvFields walk(lines[i], separator);
    for (CsvField field; walk.next(field);) found.fields.push_back(field.text);
    if (!found.fields.empty() && found.fields.front() == key) return found;
  }
  return std::nullopt;
}

/// Returns the number that all columns share; std::nullopt if they differ.
std::optional<double> shared_number(const std::optional<LvmLine>& line, char separator) {
  if (!line) return std::nullopt;
  std::optional<double> shared;
  for (std::size_t i = 1; i < line->fields.size(); ++i) {
    if (line->fields[i].empty()) continue;
    const auto number = number_in_field(line->fields[i], separator);
    if (!number || (shared && *number != *shared)) return std::nullopt;
    shared = number;
  }
  return shared;
}

}  // namespace

std::optional<LvmHeader> lvm_header(std::span<const std::string> lines, char separator,
                                    std::span<const CsvName> names) {
  if (lines.empty() || !lines.front().starts_with("LabVIEW Measurement")) return std::nullopt;
  const auto is = [&](std::string_view key, std::string_view value) {
    const auto line = lvm_line(lines, separator, key);
    return line && line->fields.size() > 1 && line->fields[1] == value;
  };
  const bool has_times = is("X_Columns", "One");
  const bool lacks_times = is("X_Columns", "No");
  LvmHeader header;
  if (!has_times && !lacks_times) return header;
  header.first_is_empty = lacks_times && !names.empty() && names.front().full == kLvmTime;
  if (const auto labels = lvm_line(lines, separator, "Y_Unit_Label")) {
    // A column of times has the first label, even if it is empty.
    std::vector<std::string> units(names.size());
    for (std::size_t i = 1; i < labels->fields.size(); ++i) {
      const std::size_t column = lacks_times && !header.first_is_empty ? i - 1 : i;
      if (column < names.size()) units[column] = unit_of_text(labels->fields[i]);
    }
    if (has_times && !names.empty() && is("X_Dimension", "Time")) units.front() = "s";
    header.units = std::move(units);
    header.units_line = labels->line;
  }
  const auto step = shared_number(lvm_line(lines, separator, "Delta_X"), separator);
  const auto start = shared_number(lvm_line(lines, separator, "X0"), separator);
  if (lacks_times && step && *step > 0.0) header.time = RegularTime{start.value_or(0.0), *step};
  return header;
}

}  // namespace rigcal::datasets
