#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rigcal {

/// The known name nearest to `name` by edit distance, or empty if none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "unknown <what> 'nmae'; did you mean 'name'? (known: a, b, c)".
std::string unknown_name_message(std::string_view what, std::string_view name,
                                 const std::vector<std::string>& known);

}  // namespace rigcal
