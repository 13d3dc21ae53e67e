#include "datasets/read/xlsx/xlsx_date_format.hpp"

#include <cstddef>

namespace rigcal::datasets {
namespace {

bool is_date_letter(char c) {
  constexpr std::string_view kLetters = "dmyhsDMYHS";
  return kLetters.find(c) != std::string_view::npos;
}

}  // namespace

bool is_date_format(std::string_view code) {
  if (code == "General" || code == "GENERAL" || code == "Standard") return false;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '"') {  // literal text
      i = code.find('"', i + 1);
      if (i == std::string_view::npos) return false;
    } else if (c == '\\' || c == '_' || c == '*') {
      ++i;  // the next character is literal
    } else if (c == '[') {
      const std::size_t end = code.find(']', i);
      if (end == std::string_view::npos) return false;
      // "[h]", "[mm]" and "[ss]" count beyond one day; other brackets are colours, conditions,
      // currencies.
      const std::string_view inside = code.substr(i + 1, end - i - 1);
      const bool counts =
          !inside.empty() && inside.find_first_not_of("hmsHMS") == std::string_view::npos;
      if (counts) return true;
      i = end;
    } else if (is_date_letter(c)) {
      return true;
    }
  }
  return false;
}

bool is_date_format(long number) {
  return (number >= 14 && number <= 22) || (number >= 27 && number <= 36) ||
         (number >= 45 && number <= 47) || (number >= 50 && number <= 58);
}

}  // namespace rigcal::datasets
