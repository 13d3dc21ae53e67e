#include "report/render.hpp"

#include <kainjow/mustache.hpp>
#include <stdexcept>

namespace rigcal::report {
namespace {

using kainjow::mustache::data;

data converted(const nlohmann::ordered_json& json) {
  if (json.is_object()) {
    data object;
    for (const auto& [name, value] : json.items()) object.set(name, converted(value));
    return object;
  }
  if (json.is_array()) {
    data list{data::type::list};
    for (const auto& value : json) list.push_back(converted(value));
    return list;
  }
  if (json.is_boolean()) return json.get<bool>() ? data::type::bool_true : data::type::bool_false;
  if (json.is_string()) return json.get<std::string>();
  if (json.is_null()) return data::type::bool_false;
  return json.dump();
}

}  // namespace

std::string render(std::string_view text, const nlohmann::ordered_json& json) {
  kainjow::mustache::mustache page{std::string(text)};
  if (!page.is_valid()) throw std::logic_error("template: " + page.error_message());
  std::string result = page.render(converted(json));
  if (!page.error_message().empty()) throw std::logic_error("template: " + page.error_message());
  return result;
}

}  // namespace rigcal::report
