#pragma once

#include <stdexcept>
#include <string>

namespace rigcal::test {

/// `text` with its first `from` replaced.
/// @throws std::logic_error  it is not there
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the fixture has no '" + from + "'");
  return text.replace(at, from.size(), to);
}

}  // namespace rigcal::test
