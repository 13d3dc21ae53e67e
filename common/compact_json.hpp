#pragma once

#include <cstddef>
#include <string>

namespace rigcal {

/// Formats JSON for a reader: a value that fits on one line is written on one line.
///
/// @param json    value of a nlohmann::basic_json
/// @param step    indentation of each level
/// @param indent  indentation of this value
template <typename Json>
std::string compact_json(const Json& json, const std::string& step,
                         const std::string& indent = "") {
  constexpr std::size_t kLine = 110;
  const std::string line = json.dump();
  if (!json.is_structured() || indent.size() + line.size() <= kLine) return line;
  const std::string deeper = indent + step;
  std::string text;
  for (const auto& [key, value] : json.items()) {
    text += (text.empty() ? "\n" : ",\n") + deeper;
    if (json.is_object()) text += Json(key).dump() + ": ";
    text += compact_json(value, step, deeper);
  }
  text += "\n" + indent;
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace rigcal
