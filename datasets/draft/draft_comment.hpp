#pragma once

#include <string>

namespace rigcal::datasets {

/// Placeholder in a draft for a value that only the user knows.
inline constexpr const char* kBlank = "FILL IN";

/// Returns a text for a comment. A control character, as some files have in their names, would end
/// it or be invalid.
inline std::string in_comment(std::string text) {
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == '\x7F') c = ' ';
  return text;
}

/// Returns a comment for the end of a line.
inline std::string comment(const std::string& text) { return "  # " + in_comment(text); }

}  // namespace rigcal::datasets
