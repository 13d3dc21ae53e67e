#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// Limits for a JSON result, checked before parsing. Deeply nested brackets would exhaust the
/// stack, and many small values the memory; lookup in an object is a linear search. For comparison,
/// a result with 24 conditions has 0.2 MB, 10 000 values and 6 levels, and its largest object has
/// one key per condition.
struct JsonLimits {
  std::size_t bytes = std::size_t{128} << 20;
  std::size_t values = 5'000'000;
  std::size_t depth = 64;
  /// Limit on the sum, over all objects, of the squared number of keys: the cost of lookup.
  std::size_t key_comparisons = 400'000'000;
  double number = 1e150;  ///< largest magnitude; its square is still finite
};

/// Parses a JSON text and checks it against the limits.
///
/// @param file  name for messages
/// @throws InputError  if the text is not JSON or exceeds a limit; starts with file:line:column
Json parse_json(std::string_view text, const std::string& file, const JsonLimits& limits = {});

/// Reads and parses a JSON file.
///
/// @param expected  description of the expected file: "the fit.json of an earlier fit"
/// @throws InputError  as for parse_json(), or if the file cannot be read, is not a regular file or
///                     is too large
Json read_json(const std::filesystem::path& file, const std::string& expected,
               const JsonLimits& limits = {});

}  // namespace rigcal::report
