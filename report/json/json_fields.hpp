#pragma once

#include <nlohmann/json.hpp>
#include <string>

// Access to values in a JSON result that may be missing.

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// Returns the text for a key, or an empty string if it is null or missing.
std::string text_of(const Json& json, const std::string& key);

/// Reports a JSON error as an InputError.
///
/// @throws InputError  always
[[noreturn]] void refuse_json(const std::string& where, const Json::exception& error);

/// Runs `work` on JSON from an external file. Converts JSON errors to InputError, since they mean
/// that the file is not a result of this version.
///
/// @param where  the file or folder, for the message
/// @throws InputError  if a value is missing or has another type
template <typename Work>
void with_json_errors(const std::string& where, const Work& work) {
  try {
    work();
  } catch (const Json::exception& error) {
    refuse_json(where, error);
  }
}

}  // namespace rigcal::report
