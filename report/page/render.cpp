#include "report/page/render.hpp"

#include <kainjow/mustache.hpp>
#include <stdexcept>
#include <utility>

namespace rigcal::report {
namespace {

using kainjow::mustache::data;

/// Takes the strings out of `json`: those of a page are megabytes. So are the copies that set() and
/// push_back() of the library make of all that lies beneath a value, hence the assignments.
data converted(nlohmann::ordered_json& json) {
  if (json.is_object()) {
    data object;
    for (auto& [name, value] : json.items()) object[name] = converted(value);
    return object;
  }
  if (json.is_array()) {
    data list{data::type::list};
    for (std::size_t i = 0; i < json.size(); ++i) list.push_back(data::type::invalid);
    for (std::size_t i = 0; i < json.size(); ++i)
      const_cast<data&>(list.list_value()[i]) = converted(json[i]);  // there is no other way in
    return list;
  }
  if (json.is_boolean()) return json.get<bool>() ? data::type::bool_true : data::type::bool_false;
  if (json.is_string()) {
    const std::string text = std::move(json.get_ref<std::string&>());
    return text;
  }
  if (json.is_null()) return data::type::bool_false;
  return json.dump();
}

}  // namespace

std::string render(std::string_view text, nlohmann::ordered_json json,
                   const std::vector<Partial>& partials) {
  kainjow::mustache::mustache page{std::string(text)};
  if (!page.is_valid()) throw std::logic_error("template: " + page.error_message());
  data values = converted(json);
  for (const Partial& each : partials) {
    const kainjow::mustache::partial made{[&each] { return std::string(each.text); }};
    values.set(each.name, made);
  }
  std::string result;
  page.render(values, [&result](const std::string& piece) { result += piece; });
  if (!page.error_message().empty()) throw std::logic_error("template: " + page.error_message());
  return result;
}

}  // namespace rigcal::report
