#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace rigcal::report {

/// A Mustache template filled with data: {{name}} escapes, {{{name}}} does not, {{#name}} repeats
/// for a list or asks whether it is true.
///
/// @throws std::logic_error  the template is not well formed
std::string render(std::string_view text, const nlohmann::ordered_json& data);

}  // namespace rigcal::report
