#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/range.hpp"
#include "model/plant/parameter.hpp"

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// One value in a JSON result, together with its path for messages. If the value is wrong, the
/// functions throw InputError with the key, what was found and what was expected. Borrows the JSON.
class JsonNode {
 public:
  /// @param kind  expected kind of file: "fit.json"
  JsonNode(const Json& json, std::string file, std::string path, std::string kind)
      : json_(json), file_(std::move(file)), path_(std::move(path)), kind_(std::move(kind)) {}

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(
        {file_}, fmt::format("key '{}': found {}, expected {}", path_,
                             shortened(json_.dump(-1, ' ', false, Json::error_handler_t::replace)),
                             expected));
  }

  JsonNode operator[](const std::string& key) const {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!json_.is_object()) fail("an object");
    const auto found = json_.find(key);
    if (found == json_.end()) {
      throw InputError({file_}, fmt::format("key '{}' is missing; is this a {}?", path, kind_));
    }
    return {*found, file_, path, kind_};
  }

  std::vector<JsonNode> items() const {
    if (!json_.is_array()) fail("a list");
    std::vector<JsonNode> result;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      result.emplace_back(json_[i], file_, fmt::format("{}[{}]", path_, i), kind_);
    }
    return result;
  }

  /// Returns a list of numbers; null becomes NaN.
  std::vector<double> reals() const {
    if (!json_.is_array()) fail("a list");
    std::vector<double> result;
    result.reserve(json_.size());
    for (std::size_t i = 0; i < json_.size(); ++i) {
      const Json& item = json_[i];
      if (!item.is_number() && !item.is_null())
        JsonNode(item, file_, fmt::format("{}[{}]", path_, i), kind_).fail("a number");
      result.push_back(item.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                      : item.get<double>());
    }
    return result;
  }

  /// Returns the keys with their values, in order.
  std::vector<std::pair<std::string, JsonNode>> members() const {
    if (!json_.is_object()) fail("an object");
    std::vector<std::pair<std::string, JsonNode>> result;
    for (const auto& [key, value] : json_.items())
      result.emplace_back(key, JsonNode(value, file_, path_ + "." + key, kind_));
    return result;
  }

  bool has(const std::string& key) const { return json_.is_object() && json_.contains(key); }
  const Json& json() const { return json_; }
  bool is_null() const { return json_.is_null(); }
  std::string string() const {
    if (!json_.is_string()) fail("text");
    return json_.get<std::string>();
  }
  bool boolean() const {
    if (!json_.is_boolean()) fail("true or false");
    return json_.get<bool>();
  }
  double real() const {
    if (!json_.is_number()) fail("a number");
    return json_.get<double>();
  }
  template <std::integral Integer>
  Integer integer() const {
    if (json_.is_number_unsigned() && std::in_range<Integer>(json_.get<std::uint64_t>()))
      return static_cast<Integer>(json_.get<std::uint64_t>());
    if (json_.is_number_integer() && !json_.is_number_unsigned() &&
        std::in_range<Integer>(json_.get<std::int64_t>()))
      return static_cast<Integer>(json_.get<std::int64_t>());
    fail("a whole number");
  }
  std::optional<Range> range() const {
    if (is_null()) return std::nullopt;
    const std::vector<JsonNode> ends = items();
    if (ends.size() != 2) fail("two numbers, or null");
    return Range{ends[0].real(), ends[1].real()};
  }

 private:
  static std::string shortened(std::string text) {
    constexpr std::size_t kLongest = 40;
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return text;
  }

  const Json& json_;
  std::string file_;
  std::string path_;
  std::string kind_;
};

/// Returns the enumeration value whose name is the text of `node`.
template <typename Values>
requires std::is_enum_v<typename Values::value_type>
typename Values::value_type one_of(const JsonNode& node, const Values& values) {
  const std::string text = node.string();
  std::string names;
  for (const auto value : values) {
    if (to_string(value) == text) return value;
    names += std::string(names.empty() ? "" : ", ") + std::string(to_string(value));
  }
  node.fail("one of " + names);
}

/// Returns the value paired with the name that is the text of `node`.
template <typename Value>
Value one_of(const JsonNode& node, const std::vector<std::pair<std::string, Value>>& choices) {
  const std::string text = node.string();
  std::string names;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    names += (names.empty() ? "" : ", ") + name;
  }
  node.fail("one of " + names);
}

/// Returns the row of the parameter table for a parameter, given its name in results as the text of
/// `name`.
int parameter_row(const JsonNode& name, model::PlantKind plant);

}  // namespace rigcal::report
