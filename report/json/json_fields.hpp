#pragma once

#include <nlohmann/json.hpp>
#include <string>

// Values of a result in JSON that may be missing.

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// The text of a key, or an empty one where it is null or missing.
std::string text_of(const Json& json, const std::string& key);

/// @throws InputError  always
[[noreturn]] void refuse_json(const std::string& where, const Json::exception& error);

/// Does work on foreign JSON; what is JSON but no result of this version is an error of the input.
///
/// @param where  the file or folder
/// @throws InputError  a value is missing or of another kind
template <typename Work>
void with_json_errors(const std::string& where, const Work& work) {
  try {
    work();
  } catch (const Json::exception& error) {
    refuse_json(where, error);
  }
}

}  // namespace rigcal::report
