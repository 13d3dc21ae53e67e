#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

// Values of a result in JSON that may be missing.

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// The text of a key, or an empty one where it is null or missing.
std::string text_of(const Json& json, const std::string& key);
std::optional<double> number_of(const Json& json, const std::string& key);

}  // namespace rigcal::report
