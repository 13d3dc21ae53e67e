#include "datasets/read/csv/csv_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parse_double.hpp"
#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kMostShown = 40;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Returns the end of the field that starts at `begin`: its separator, or the end of the line.
std::size_t field_end(std::string_view line, std::size_t begin, char separator) {
  std::size_t first = begin;
  while (first < line.size() && line[first] == ' ') ++first;
  if (first < line.size() && line[first] == '"') {
    bool quoted = false;
    for (std::size_t i = first; i < line.size(); ++i) {
      if (line[i] == '"') quoted = !quoted;  // a doubled quote closes and reopens at once
      if (line[i] == separator && !quoted) return i;
    }
    if (!quoted) return line.size();
    // A quote that is never closed is an ordinary character.
  }
  return std::min(line.find(separator, first), line.size());
}

/// Whether the bytes can be UTF-8: every lead byte is followed by its continuation bytes.
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x80) continue;
    const int following = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC2 ? 1 : -1;
    if (following < 0 || lead > 0xF4) return false;
    for (int k = 0; k < following; ++k)
      if (++i == text.size() || !is_continuation(text[i])) return false;
  }
  return true;
}

/// Returns the text in UTF-8. Other text is assumed to be Latin-1, which loggers on Windows write.
std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string result;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      result += c;
    } else {
      result += static_cast<char>(0xC0U | (code >> 6U));
      result += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return result;
}

std::string unquoted(std::string_view text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::string(text);
  std::string result;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    result += text[i];
    if (text[i] == '"' && text[i + 1] == '"') ++i;
  }
  return std::string(trimmed(result));
}

/// Returns "x" for "x [mm]", and the text itself if it does not end in brackets.
std::string without_unit(std::string_view text) {
  const std::string_view name =
      trimmed(text.substr(0, brackets_at_end(text).value_or(text.size())));
  return std::string(name.empty() ? text : name);
}

}  // namespace

bool CsvFields::next(CsvField& field) {
  if (done_) return false;
  if (separator_ == ' ') return next_between_blanks(field);
  const std::size_t end = field_end(line_, position_, separator_);
  std::size_t begin = position_;
  while (begin < end && is_blank(line_[begin])) ++begin;
  std::size_t stop = end;
  while (stop > begin && is_blank(line_[stop - 1])) --stop;
  field = {line_.substr(begin, stop - begin), begin};
  done_ = end == line_.size();
  position_ = end + 1;
  return true;
}

bool CsvFields::next_between_blanks(CsvField& field) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t begin = std::min(line_.find_first_not_of(kBlanks, position_), line_.size());
  const std::size_t end = std::min(line_.find_first_of(kBlanks, begin), line_.size());
  field = {line_.substr(begin, end - begin), begin};
  done_ = line_.find_first_not_of(kBlanks, end) == std::string_view::npos;
  position_ = end;
  return true;
}

char find_separator(std::string_view header) {
  for (const char separator : {'\t', ';'})
    if (field_end(header, 0, separator) < header.size()) return separator;
  return ',';
}

std::vector<CsvName> header_names(std::string_view header, char separator) {
  std::vector<CsvName> names;
  CsvFields fields(header, separator);
  for (CsvField field; fields.next(field);) {
    std::string full = as_utf8(unquoted(field.text));
    // With spaces as separators, a unit in brackets is a separate field.
    const bool is_unit = separator == ' ' && !names.empty() && brackets_at_end(full) == 0;
    if (is_unit) {
      full.insert(0, names.back().full + " ");
      names.pop_back();
    }
    names.push_back({full, without_unit(full)});
  }
  return names;
}

CsvName header_name(std::string_view field) {
  const std::string_view full = trimmed(field);
  return {std::string(full), without_unit(full)};
}

std::vector<std::string> short_names(const std::vector<CsvName>& names) {
  std::vector<std::string> result;
  for (const CsvName& name : names) {
    const bool is_unique = std::count_if(names.begin(), names.end(), [&](const CsvName& other) {
                             return other.plain == name.plain;
                           }) == 1;
    result.push_back(is_unique ? name.plain : name.full);
  }
  return result;
}

std::optional<FoundColumn> find_column(const std::vector<CsvName>& names,
                                       const std::string& wanted) {
  for (const auto member : {&CsvName::full, &CsvName::plain}) {
    const auto is_wanted = [&](const CsvName& name) { return name.*member == wanted; };
    const auto first = std::find_if(names.begin(), names.end(), is_wanted);
    if (first == names.end()) continue;
    FoundColumn found{static_cast<std::size_t>(first - names.begin()), std::nullopt};
    const auto second = std::find_if(first + 1, names.end(), is_wanted);
    if (second != names.end()) found.second = static_cast<std::size_t>(second - names.begin());
    return found;
  }
  return std::nullopt;
}

std::optional<double> csv_number(std::string_view text, bool decimal_comma) {
  if (text.size() > 2 && text.front() == '"' && text.back() == '"')
    text = trimmed(text.substr(1, text.size() - 2));
  std::array<char, 64> pointed{};
  if (decimal_comma && text.find(',') != std::string_view::npos) {
    if (text.size() > pointed.size()) return std::nullopt;
    std::replace_copy(text.begin(), text.end(), pointed.begin(), ',', '.');
    text = {pointed.data(), text.size()};
  }
  if (text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.'))
    text.remove_prefix(1);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = parse_double(text.data(), end, value);
  if (error != std::errc{} || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> number_in_field(std::string_view text, char separator) {
  const bool decimal_comma = separator != ',' || text.starts_with('"');
  if (const auto number = csv_number(text, decimal_comma)) return number;
  // Fortran writes "1.5D-03".
  const std::size_t exponent = text.find_first_of("dD");
  if (exponent == std::string_view::npos || exponent == 0 ||
      !(is_digit(text[exponent - 1]) || text[exponent - 1] == '.'))
    return std::nullopt;
  std::string number(text);
  number[exponent] = 'e';
  return csv_number(number, decimal_comma);
}

std::string shown(std::string_view text) {
  std::size_t length = std::min(text.size(), kMostShown);
  while (length < text.size() && length > 0 && is_continuation(text[length])) --length;
  std::string result = as_utf8(text.substr(0, length));
  for (char& c : result)
    if ((c >= 0 && c < ' ') || c == '\x7F') c = '?';
  return length < text.size() ? result + "..." : result;
}

long character_column(std::string_view line, std::size_t byte) {
  const std::string_view before = line.substr(0, byte);
  if (!is_utf8(line)) return static_cast<long>(before.size()) + 1;
  return 1 + static_cast<long>(before.size()) -
         static_cast<long>(std::count_if(before.begin(), before.end(), is_continuation));
}

}  // namespace rigcal::datasets
