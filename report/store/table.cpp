#include "report/store/table.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "common/error.hpp"
#include "datasets/read/csv/csv_text.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kMostColumns = 10'000;
/// Maximum length of a double's shortest text, such as -2.2250738585072014e-308.
constexpr std::size_t kLongestNumber = 24;

}  // namespace

const std::vector<double>* Table::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

std::string csv_of(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.names, ","));
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().size();
  // Writing tables dominates the time to write results, so each row is formatted in place with a
  // compiled format.
  std::vector<char> row(table.columns.size() * (kLongestNumber + 1));
  for (std::size_t i = 0; i < rows; ++i) {
    char* at = row.data();
    for (const std::vector<double>& column : table.columns) {
      if (std::isfinite(column[i])) at = fmt::format_to(at, FMT_COMPILE("{}"), column[i]);
      *at++ = ',';
    }
    if (at != row.data()) at[-1] = '\n';
    text.append(row.data(), at);
  }
  return text;
}

Table parse_table(std::string_view text, const std::string& file) {
  Table table;
  std::size_t time = 0;  // index of the time column, if there is one
  double before_s = -std::numeric_limits<double>::infinity();
  long line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    if (table.names.empty()) {
      for (const datasets::CsvName& name : datasets::header_names(line, ','))
        table.names.push_back(name.full);
      if (table.names.size() > kMostColumns)
        throw InputError({file, line_number}, fmt::format("{} columns; expected at most {}",
                                                          table.names.size(), kMostColumns));
      table.columns.resize(table.names.size());
      time = static_cast<std::size_t>(std::find(table.names.begin(), table.names.end(), "time_s") -
                                      table.names.begin());
      continue;
    }
    datasets::CsvFields fields(line, ',');
    datasets::CsvField field;
    bool is_there = fields.next(field);
    for (std::size_t i = 0; is_there || i < table.names.size(); ++i) {
      const auto fail = [&](const std::string& expected) {
        throw InputError({file, line_number, static_cast<long>(field.begin) + 1},
                         fmt::format("column '{}': expected {}",
                                     table.names[std::min(i, table.names.size() - 1)], expected));
      };
      if (!is_there || i == table.names.size())
        fail(fmt::format("{} fields in a row", table.names.size()));
      const auto number = datasets::csv_number(field.text, false);
      if (!number && !field.text.empty()) fail("a number");
      const double value = number.value_or(std::numeric_limits<double>::quiet_NaN());
      if (i == time && !(value > before_s)) fail("a time after the one before it");
      if (i == time) before_s = value;
      table.columns[i].push_back(value);
      is_there = fields.next(field);
    }
  }
  return table;
}

}  // namespace rigcal::report
