#include "report/json/json_fields.hpp"

#include <fmt/format.h>

#include "common/error.hpp"

namespace rigcal::report {

std::string text_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? std::string() : found->get<std::string>();
}

void refuse_json(const std::string& where, const Json::exception& error) {
  throw InputError(
      {where},
      fmt::format("the result is not in the form that this version writes: {}", error.what()));
}

}  // namespace rigcal::report
