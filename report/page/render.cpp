#include "report/page/render.hpp"

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

std::string render(std::string_view text, const nlohmann::ordered_json& json,
                   const std::vector<Partial>& partials) {
  kainjow::mustache::mustache page{std::string(text)};
  if (!page.is_valid()) throw std::logic_error("template: " + page.error_message());
  data values = converted(json);
  for (const Partial& each : partials) {
    const kainjow::mustache::partial made{[&each] { return std::string(each.text); }};
    values.set(each.name, made);
  }
  std::string result = page.render(values);
  if (!page.error_message().empty()) throw std::logic_error("template: " + page.error_message());
  return result;
}

}  // namespace rigcal::report
