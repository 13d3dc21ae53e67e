#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// Limits of a result in JSON, checked before it is parsed: nested brackets would exhaust the
/// stack, many small values the memory, and an object searches its keys one by one. A result of 24
/// conditions has 0.2 MB, 10 000 values and 6 levels; its largest object has one key per condition.
struct JsonLimits {
  std::size_t bytes = std::size_t{128} << 20;
  std::size_t values = 5'000'000;
  std::size_t depth = 64;
  /// Sum over all objects of the square of their number of keys: the cost of searching them.
  std::size_t key_comparisons = 400'000'000;
  double number = 1e150;  ///< the square of such a number is still finite
};

/// Parses a JSON text and checks it against the limits.
///
/// @param file  for messages
/// @throws InputError  file:line:column: not JSON, or beyond a limit
Json parse_json(std::string_view text, const std::string& file, const JsonLimits& limits = {});

/// Reads and parses a JSON file.
///
/// @param expected  what the file should be, in words: "the fit.json of an earlier fit"
/// @throws InputError  as parse_json(); or the file cannot be read, is not regular, or is too large
Json read_json(const std::filesystem::path& file, const std::string& expected,
               const JsonLimits& limits = {});

}  // namespace rigcal::report
