#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace rigcal::report {

/// Replaces each character in the table with its text.
template <std::size_t N>
std::string replaced(std::string_view text,
                     const std::array<std::pair<char, std::string_view>, N>& table) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    const auto row =
        std::find_if(table.begin(), table.end(), [c](const auto& each) { return each.first == c; });
    result += row == table.end() ? std::string_view(&c, 1) : row->second;
  }
  return result;
}

/// Escapes a text for HTML and SVG, also for use in quoted attributes.
inline std::string escaped(std::string_view text) {
  using Row = std::pair<char, std::string_view>;
  return replaced(text, std::array{Row{'&', "&amp;"}, Row{'<', "&lt;"}, Row{'>', "&gt;"},
                                   Row{'"', "&quot;"}, Row{'\'', "&#39;"}});
}

}  // namespace rigcal::report
