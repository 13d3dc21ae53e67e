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

/// Runs work on foreign JSON. JSON that is no result of this version becomes an error of the input.
///
/// @param where  the file or folder
/// @throws InputError  a value is missing or has another type
template <typename Work>
void with_json_errors(const std::string& where, const Work& work) {
  try {
    work();
  } catch (const Json::exception& error) {
    refuse_json(where, error);
  }
}

}  // namespace rigcal::report
