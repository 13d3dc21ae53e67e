#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::report {

/// A template that {{>name}} takes in. Data has its names too, so they must differ.
struct Partial {
  std::string name;
  std::string_view text;
};

/// A Mustache template filled with data: {{name}} escapes, {{{name}}} does not, {{#name}} repeats
/// for a list or asks whether it is true.
///
/// @throws std::logic_error  the template is not well formed
std::string render(std::string_view text, nlohmann::ordered_json data,
                   const std::vector<Partial>& partials = {});

}  // namespace rigcal::report
