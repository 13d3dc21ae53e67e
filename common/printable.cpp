#include "common/printable.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace rigcal {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0: the first byte does not start a character
};

/// Returns the UTF-8 character (RFC 3629) at the start of a non-empty text.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80U) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < bytes) return {};
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
  if (code < kLeast[bytes] || code > 0x10FFFFU || surrogate) return {};
  return {code, bytes};
}

bool acts_on_a_terminal(std::uint32_t code) {
  if (code < 0x20U) return code != '\n';
  return (code >= 0x7FU && code <= 0x9FU) || code == 0x061CU || code == 0x200EU ||
         code == 0x200FU || (code >= 0x2028U && code <= 0x202EU) ||
         (code >= 0x2066U && code <= 0x2069U);
}

/// Length of the escape sequence for bold or a colour at the start of a text; 0 if there is none.
std::size_t colour_length(std::string_view text) {
  if (!text.starts_with("\x1b[")) return 0;
  const std::size_t end = text.find_first_not_of("0123456789;", 2);
  if (end == std::string_view::npos || text[end] != 'm') return 0;
  for (std::string_view rest = text.substr(2, end - 2); !rest.empty();) {
    const std::size_t length = rest.find(';');
    const std::string_view code = rest.substr(0, length);
    const bool colour = code.size() == 2 && (code[0] == '3' || code[0] == '9') && code[1] <= '7';
    if (!colour && code != "0" && code != "1" && code != "2") return 0;
    rest.remove_prefix(length == std::string_view::npos ? rest.size() : length + 1);
  }
  return end + 1;
}

}  // namespace

std::string printable(std::string_view text, bool coloured) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    std::size_t length = coloured ? colour_length(text) : 0;
    if (length > 0) {
      result += text.substr(0, length);
    } else {
      const Character character = first_character(text);
      length = character.bytes > 0 ? character.bytes : 1;
      if (character.bytes == 0)
        result += fmt::format("\\x{:02X}", static_cast<unsigned char>(text.front()));
      else if (acts_on_a_terminal(character.code))
        result += fmt::format("\\u{:04X}", character.code);
      else
        result += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return result;
}

void say(std::string_view text) { std::fputs(printable(text).c_str(), stderr); }

}  // namespace rigcal
