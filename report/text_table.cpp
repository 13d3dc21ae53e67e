#include "report/text_table.hpp"

#include <algorithm>

namespace rigcal::report {

std::size_t text_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string TextTable::text() const {
  std::vector<std::string> titles;
  std::vector<std::size_t> width;
  for (const Column& column : columns_) {
    titles.push_back(column.title);
    width.push_back(text_width(column.title));
  }
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < width.size(); ++i)
      width[i] = std::max(width[i], text_width(row[i]));
  }
  std::string result;
  const auto add_line = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < width.size(); ++i) {
      const std::string blanks(width[i] - text_width(row[i]), ' ');
      if (i > 0) line += "  ";
      line += columns_[i].align == Align::left ? row[i] + blanks : blanks + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + "\n";
  };
  add_line(titles);
  for (const auto& row : rows_) add_line(row);
  return result;
}

}  // namespace rigcal::report
