#pragma once

#include <stdexcept>
#include <string>

namespace rigcal::test {

/// Returns `text` with the first occurrence of `from` replaced.
/// @throws std::logic_error  if `from` does not occur
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the fixture has no '" + from + "'");
  return text.replace(at, from.size(), to);
}

}  // namespace rigcal::test
