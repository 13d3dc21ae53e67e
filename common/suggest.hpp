#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal {

/// Returns the known name closest to `name` by edit distance; empty if none is close.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// Returns a message such as "unknown <what> 'nmae'; did you mean 'name'? (known: a, b, c)".
std::string unknown_name_message(std::string_view what, std::string_view name,
                                 const std::vector<std::string>& known);

}  // namespace rigcal
