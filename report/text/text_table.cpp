#include "report/text/text_table.hpp"

#include <algorithm>

namespace rigcal::report {
namespace {

constexpr std::size_t kGap = 2;  ///< spaces between columns

/// Breaks the lines of a cell that are longer than `columns`.
std::vector<std::string> broken_lines(const std::vector<std::string>& lines, std::size_t columns) {
  std::vector<std::string> result;
  for (const std::string& line : lines) {
    std::string text = wrapped(line, columns, 2);
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
      result.push_back(text.substr(0, end));
      text.erase(0, end + 1);
    }
    result.push_back(std::move(text));
  }
  return result;
}

}  // namespace

std::string on_one_line(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {
      const std::size_t end = text.find_first_not_of("[;0123456789", i + 1);
      if (end != std::string::npos && text[end] == 'm') {
        i = end;
        continue;
      }
    }
    if (static_cast<unsigned char>(text[i]) < 0x20U || text[i] == '\x7f') text[i] = ' ';
  }
  return text;
}

std::size_t text_width(std::string_view text) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {
      i = std::min(text.find('m', i), text.size() - 1);
      continue;
    }
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) ++width;
  }
  return width;
}

std::string wrapped(std::string_view line, std::size_t columns, std::size_t indent) {
  if (columns == 0 || text_width(line) <= columns) return std::string(line);
  std::string result;
  std::size_t width = 0;
  for (std::size_t begin = 0; begin < line.size();) {
    // A word includes the spaces before it, so that the indentation is kept.
    const std::size_t letters = std::min(line.find_first_not_of(' ', begin), line.size());
    const std::size_t end = std::min(line.find(' ', letters), line.size());
    std::string_view word = line.substr(begin, end - begin);
    if (width > 0 && width + text_width(word) > columns) {
      word = line.substr(letters, end - letters);
      result += "\n" + std::string(indent, ' ');
      width = indent;
    }
    result += word;
    width += text_width(word);
    begin = end;
  }
  return result;
}

std::string wrapped_lines(std::string_view text, std::size_t columns) {
  constexpr std::size_t kDeeper = 2;
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    result += wrapped(line, columns, std::min(line.find_first_not_of(' '), line.size()) + kDeeper);
    if (end < text.size()) result += "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

void TextTable::add(std::vector<std::string> row) {
  std::vector<std::vector<std::string>> cells;
  for (std::string& text : row) cells.push_back({std::move(text)});
  add_lines(std::move(cells));
}

void TextTable::add_lines(std::vector<std::vector<std::string>> row) {
  for (auto& cell : row)
    for (std::string& line : cell) line = on_one_line(std::move(line));
  rows_.push_back(std::move(row));
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> width;
  for (const Column& column : columns_) width.push_back(text_width(column.title));
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < width.size(); ++i)
      for (const std::string& line : row[i]) width[i] = std::max(width[i], text_width(line));
  }
  return width;
}

std::size_t TextTable::width() const {
  std::size_t all = 0;
  for (const std::size_t each : widths()) all += each + kGap;
  return all > kGap ? all - kGap : 0;
}

std::vector<bool> TextTable::shown(std::size_t columns) const {
  const std::vector<std::size_t> width = widths();
  std::vector<bool> is_shown(width.size(), true);
  std::size_t all = 0;
  for (const std::size_t each : width) all += each + kGap;
  while (columns > 0 && all > columns + kGap) {
    std::size_t next = width.size();
    for (std::size_t i = 0; i < width.size(); ++i) {
      if (!is_shown[i] || columns_[i].spare == 0) continue;
      if (next == width.size() || columns_[i].spare > columns_[next].spare) next = i;
    }
    if (next == width.size()) break;
    is_shown[next] = false;
    all -= width[next] + kGap;
  }
  return is_shown;
}

std::vector<std::string> TextTable::left_out(std::size_t columns) const {
  const std::vector<bool> is_shown = shown(columns);
  std::vector<std::string> titles;
  for (std::size_t i = 0; i < is_shown.size(); ++i)
    if (!is_shown[i]) titles.push_back(columns_[i].title);
  return titles;
}

std::vector<std::vector<std::size_t>> TextTable::blocks(std::size_t columns) const {
  const std::vector<std::size_t> width = widths();
  const std::vector<bool> is_shown = shown(columns);
  std::vector<std::size_t> keys;
  std::size_t of_keys = 0;
  for (std::size_t i = 0; i < keys_; ++i) {
    if (!is_shown[i]) continue;
    keys.push_back(i);
    of_keys += width[i] + kGap;
  }
  std::vector<std::vector<std::size_t>> result{keys};
  std::size_t all = of_keys;
  for (std::size_t i = keys_; i < width.size(); ++i) {
    if (!is_shown[i]) continue;
    if (columns > 0 && all + width[i] > columns && result.back().size() > keys.size()) {
      result.push_back(keys);
      all = of_keys;
    }
    result.back().push_back(i);
    all += width[i] + kGap;
  }
  return result;
}

std::string TextTable::text(std::size_t columns) const {
  constexpr std::size_t kNarrowest = 16;  // below it, words would be broken into a ladder
  std::string result;
  for (const std::vector<std::size_t>& block : blocks(columns)) {
    std::vector<std::size_t> width = widths();
    std::size_t before_last = 0;
    for (const std::size_t i : block) before_last += i == block.back() ? 0 : width[i] + kGap;
    // If not even one column fits beside the keys, its lines are broken within it.
    const bool breaks = columns >= before_last + kNarrowest &&
                        before_last + width[block.back()] > columns && block.size() > 1;
    if (breaks) width[block.back()] = columns - before_last;
    const auto add_line = [&](const auto& cell) {
      std::string line;
      for (const std::size_t i : block) {
        const std::string& text = cell(i);
        const std::size_t printed = text_width(text);
        const std::string blanks(width[i] > printed ? width[i] - printed : 0, ' ');
        if (i != block.front()) line += std::string(kGap, ' ');
        line += columns_[i].align == Align::left ? text + blanks : blanks + text;
      }
      line.erase(line.find_last_not_of(' ') + 1);
      result += line + "\n";
    };
    const bool titled = std::any_of(columns_.begin(), columns_.end(),
                                    [](const Column& column) { return !column.title.empty(); });
    if (titled) add_line([&](std::size_t i) -> const std::string& { return columns_[i].title; });
    for (auto row : rows_) {
      if (breaks) row[block.back()] = broken_lines(row[block.back()], width[block.back()]);
      std::size_t lines = 1;
      for (const std::size_t i : block) lines = std::max(lines, row[i].size());
      for (std::size_t line = 0; line < lines; ++line) {
        add_line([&](std::size_t i) -> const std::string& {
          static const std::string blank;
          return line < row[i].size() ? row[i][line] : blank;
        });
      }
    }
  }
  return result;
}

}  // namespace rigcal::report
