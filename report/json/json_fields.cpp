#include "report/json/json_fields.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"

namespace rigcal::report {

std::string text_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? std::string() : found->get<std::string>();
}

std::optional<double> number_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

long count_at(const Json& json, const std::string& key) { return as_count(json.at(key)); }

long as_count(const Json& number) {
  constexpr double kLargest = 1e9;
  const auto count = number.get<double>();
  if (count >= 0.0 && count <= kLargest && count == std::floor(count))
    return static_cast<long>(count);
  throw Json::out_of_range::create(
      401, fmt::format("found {}, expected a whole number from 0 to {}", count, kLargest), &number);
}

void refuse_json(const std::string& where, const Json::exception& error) {
  throw InputError({where},
                   fmt::format("the result is not as this version writes it: {}", error.what()));
}

}  // namespace rigcal::report
