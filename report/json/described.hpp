#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/describe.hpp"
#include "report/json/json_node.hpp"

// JSON writer, reader and schema for structs with a description (RIGCAL_DESCRIBE).

namespace rigcal::report {

/// Finds the value of a key; null if the key is missing.
template <typename T, typename Key>
const T* find(const Keyed<T, Key>& keyed, const std::type_identity_t<Key>& key) {
  for (const auto& [name, value] : keyed)
    if (name == key) return &value;
  return nullptr;
}

/// Specialised for types that results store as keys from a table. A specialisation has text(value)
/// and from_text(text); the latter returns std::nullopt for an unknown key.
template <typename T>
struct KeysOf;
template <typename T>
concept HasKeys = requires(T value) {
  KeysOf<T>::text(value);
};

/// Returns all values of an enumeration that results store as to_string(). An enumeration without
/// RIGCAL_NAMES has a specialisation.
template <typename Enum>
std::vector<Enum> every() {
  return enumerators_like(Enum{});
}

namespace described {

/// True if T is a specialisation of the template: is_a<std::optional<int>, std::optional>.
template <typename T, template <typename...> typename Of>
inline constexpr bool is_a = false;
template <template <typename...> typename Of, typename... Arguments>
inline constexpr bool is_a<Of<Arguments...>, Of> = true;
template <typename T>
struct LaterOf;
template <typename T>
struct LaterOf<Later<T>> {
  using Type = T;
};
template <typename T>
inline constexpr bool is_array = false;
template <typename T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;
template <typename T>
inline constexpr bool is_keyed = false;
template <typename T>
inline constexpr bool is_keyed<Keyed<T>> = true;
template <typename T, HasKeys Key>
inline constexpr bool is_keyed<Keyed<T, Key>> = true;

/// Convert between keys and their JSON text.
inline const std::string& key_text(const std::string& key) { return key; }
template <HasKeys Key>
std::string key_text(Key key) {
  return std::string(KeysOf<Key>::text(key));
}
inline void read_key(const JsonNode& /*node*/, const std::string& text, std::string& key) {
  key = text;
}
template <HasKeys Key>
void read_key(const JsonNode& node, const std::string& text, Key& key) {
  const std::optional<Key> known = KeysOf<Key>::from_text(text);
  if (!known) node.fail(fmt::format("another key than \"{}\"", text));
  key = *known;
}

/// Largest count in a result. Sums of several hundred such counts are still exact as doubles.
inline constexpr long kMostCounted = 1'000'000'000;

struct Anything {
  template <typename T>
  void operator()(const char* /*name*/, const T& /*member*/) const {}
};

template <typename T>
concept Struct = requires(T& value) {
  T::describe(value, Anything{});
};

/// Returns the member with this name. It must be described and of this type.
template <typename Member, typename Self>
Member& described_member(Self& self, std::string_view name) {
  Member* found = nullptr;
  Self::describe(self, [&]<typename Each>(const char* each, Each& member) {
    if constexpr (std::same_as<Each, Member>) {
      if (each == name) found = &member;
    }
  });
  return *found;
}

/// True for members that results may lack.
template <typename M>
inline constexpr bool may_be_missing =
    is_a<M, Omittable> || is_a<M, Later> || std::same_as<M, Json>;

inline std::string key_of(const char* member) {
  std::string key(member);
  if (key.back() == '_') key.pop_back();
  return key;
}

}  // namespace described

/// Returns a number for JSON, or std::nullopt if it is not finite.
inline std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

inline std::optional<double> finite(const std::optional<double>& value) {
  return value ? finite(*value) : std::nullopt;
}

template <typename T>
Json json_of(const T& value);
template <typename T>
void read_into(const JsonNode& node, T& value);

namespace described {

template <typename Row>
void add_columns(const Columns<Row>& rows, Json& json) {
  const Row sample{};
  Row::describe(sample, [&]<typename M>(const char* name, const M& /*member*/) {
    Json column = Json::object();
    for (const Row& row : rows) {
      const M& member = described_member<const M>(row, name);
      if constexpr (is_a<M, Omittable>) {
        if (!member) continue;
      }
      column[key_text(row.channel)] = json_of(member);
    }
    if (!is_a<M, Omittable> || !column.empty()) json[key_of(name)] = std::move(column);
  });
}

/// The first column names the rows.
template <typename Row>
void read_columns(const JsonNode& node, Columns<Row>& rows) {
  rows.clear();
  bool is_first = true;
  const Row sample{};
  Row::describe(sample, [&]<typename M>(const char* name, const M& /*member*/) {
    const std::string key = key_of(name);
    const bool names_rows = std::exchange(is_first, false);
    if (may_be_missing<M> && (!node.has(key) || node[key].is_null())) return;
    for (const auto& [text, value] : node[key].members()) {
      auto channel = sample.channel;
      read_key(value, text, channel);
      if (names_rows) rows.emplace_back().channel = channel;
      for (Row& row : rows)
        if (row.channel == channel) read_into(value, described_member<M>(row, name));
    }
  });
}

}  // namespace described

/// Converts a value to JSON. Numbers that are not finite become null, since JSON has neither NaN
/// nor infinity.
template <typename T>
Json json_of(const T& value) {
  using namespace described;
  if constexpr (is_a<T, Later>) {
    return json_of<typename LaterOf<T>::Type>(value);
  } else if constexpr (std::same_as<T, Json>) {
    return value;
  } else if constexpr (std::floating_point<T>) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
  } else if constexpr (HasKeys<T>) {
    return key_text(value);
  } else if constexpr (std::is_enum_v<T>) {
    return std::string(to_string(value));
  } else if constexpr (std::same_as<T, Range>) {
    return Json::array({json_of(value.low), json_of(value.high)});
  } else if constexpr (std::same_as<T, Eigen::MatrixXd>) {
    Json json = Json::array();
    for (const auto& row : value.rowwise())
      json.push_back(json_of(std::vector<double>(row.begin(), row.end())));
    return json;
  } else if constexpr (is_a<T, std::optional> || is_a<T, Omittable>) {
    return value ? json_of(*value) : Json(nullptr);
  } else if constexpr (is_keyed<T>) {
    Json json = Json::object();
    for (const auto& [key, member] : value) json[key_text(key)] = json_of(member);
    return json;
  } else if constexpr (is_a<T, std::vector> || is_array<T>) {
    Json json = Json::array();
    for (const auto& each : value) json.push_back(json_of(each));
    return json;
  } else if constexpr (Struct<T>) {
    Json json = Json::object();
    T::describe(value, [&json]<typename M>(const char* name, const M& member) {
      if constexpr (is_a<M, Omittable>) {
        if (!member) return;
      }
      if constexpr (is_a<M, Columns>) {
        add_columns(member, json);
      } else {
        json[key_of(name)] = json_of(member);
      }
    });
    return json;
  } else {
    return Json(value);
  }
}

/// Reads JSON written by json_of(). Ignores unknown keys.
///
/// @throws InputError  if a key is missing or has another type; names file, key and what was
///                     expected
template <typename T>
void read_into(const JsonNode& node, T& value) {
  using namespace described;
  if constexpr (is_a<T, Later>) {
    read_into<typename LaterOf<T>::Type>(node, value);
  } else if constexpr (std::same_as<T, Json>) {
    value = node.json();
  } else if constexpr (std::same_as<T, bool>) {
    value = node.boolean();
  } else if constexpr (std::signed_integral<T>) {
    value = node.integer<T>();
    if (value < 0 || value > kMostCounted)
      node.fail(fmt::format("a whole number from 0 to {}", kMostCounted));
  } else if constexpr (std::integral<T>) {
    value = node.integer<T>();
  } else if constexpr (std::floating_point<T>) {
    value = node.is_null() ? std::numeric_limits<T>::quiet_NaN() : node.real();
  } else if constexpr (std::same_as<T, std::string>) {
    value = node.string();
  } else if constexpr (HasKeys<T>) {
    read_key(node, node.string(), value);
  } else if constexpr (std::is_enum_v<T>) {
    value = one_of(node, every<T>());
  } else if constexpr (std::same_as<T, Range>) {
    const auto ends = node.items();
    if (ends.size() != 2) node.fail("two numbers");
    read_into(ends[0], value.low);
    read_into(ends[1], value.high);
  } else if constexpr (std::same_as<T, Eigen::MatrixXd>) {
    const auto items = node.items();
    std::vector<std::vector<double>> rows;
    for (const JsonNode& item : items) {
      rows.push_back(item.reals());
      const std::size_t columns = rows.front().size();
      if (rows.back().size() != columns) item.fail(fmt::format("a list of {}", columns));
    }
    const std::size_t columns = rows.empty() ? 0 : rows.front().size();
    value.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
    for (std::size_t i = 0; i < rows.size(); ++i)
      value.row(static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), static_cast<Eigen::Index>(columns));
  } else if constexpr (is_a<T, std::optional> || is_a<T, Omittable>) {
    value.reset();
    if constexpr (is_a<T, Omittable>) {
      // If the value itself is optional, null is a valid value.
      if constexpr (is_a<typename T::value_type, std::optional>) value.emplace();
    }
    if (!node.is_null()) read_into(node, value.emplace());
  } else if constexpr (is_keyed<T>) {
    value.clear();
    for (const auto& [key, member] : node.members()) {
      auto& [own, read] = value.emplace_back();
      read_key(node, key, own);
      read_into(member, read);
    }
  } else if constexpr (std::same_as<T, std::vector<double>>) {
    value = node.reals();
  } else if constexpr (is_a<T, std::vector>) {
    value.clear();
    for (const JsonNode& item : node.items()) {
      typename T::value_type each{};
      read_into(item, each);
      value.push_back(std::move(each));
    }
  } else if constexpr (is_array<T>) {
    const auto items = node.items();
    if (items.size() != value.size()) node.fail(fmt::format("a list of {}", value.size()));
    for (std::size_t i = 0; i < value.size(); ++i) read_into(items[i], value[i]);
  } else {
    static_assert(Struct<T>);
    T::describe(value, [&node]<typename M>(const char* name, M& member) {
      const std::string key = key_of(name);
      if constexpr (may_be_missing<M>) {
        member = M();
        if (!node.has(key)) return;
      }
      if constexpr (is_a<M, Columns>) {
        read_columns(node, member);
      } else {
        read_into(node[key], member);
      }
    });
  }
}

/// Changes a value to what read_into() would read from its JSON text: a number that is not finite
/// is NaN or absent, and bytes that are not UTF-8 are replaced.
template <typename T>
void as_read_back(T& value) {
  using namespace described;
  if constexpr (is_a<T, Later>) {
    as_read_back(static_cast<typename LaterOf<T>::Type&>(value));
  } else if constexpr (std::same_as<T, Json> || std::same_as<T, std::vector<bool>> || HasKeys<T>) {
    return;
  } else if constexpr (std::floating_point<T>) {
    if (!std::isfinite(value)) value = std::numeric_limits<T>::quiet_NaN();
  } else if constexpr (std::same_as<T, std::string>) {
    if (std::any_of(value.begin(), value.end(), [](char c) { return (c & '\x80') != 0; }))
      value = Json::parse(Json(value).dump(-1, ' ', false, Json::error_handler_t::replace));
  } else if constexpr (std::same_as<T, Range>) {
    as_read_back(value.low);
    as_read_back(value.high);
  } else if constexpr (std::same_as<T, Eigen::MatrixXd>) {
    for (double& number : value.reshaped()) as_read_back(number);
  } else if constexpr (is_a<T, std::optional> || is_a<T, Omittable>) {
    if (!value) return;
    if constexpr (std::floating_point<typename T::value_type>) {
      if (!std::isfinite(*value)) value.reset();
    } else {
      as_read_back(*value);
    }
  } else if constexpr (is_keyed<T>) {
    for (auto& [key, member] : value) {
      as_read_back(key);
      as_read_back(member);
    }
  } else if constexpr (std::ranges::range<T>) {
    for (auto& each : value) as_read_back(each);
  } else if constexpr (Struct<T>) {
    T::describe(value, [](const char* /*name*/, auto& member) { as_read_back(member); });
  } else {
    static_assert(std::integral<T> || std::is_enum_v<T>);
  }
}

/// Returns the JSON schema (draft 7) for the output of json_of() for a type.
template <typename T>
Json schema_of() {
  using namespace described;
  if constexpr (is_a<T, Later>) {
    return schema_of<typename LaterOf<T>::Type>();
  } else if constexpr (std::same_as<T, Json>) {
    return Json::object();
  } else if constexpr (std::same_as<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (std::integral<T>) {
    return {{"type", "integer"}, {"minimum", 0}};
  } else if constexpr (std::floating_point<T>) {
    return {{"type", {"number", "null"}}};
  } else if constexpr (std::same_as<T, std::string> || HasKeys<T>) {
    return {{"type", "string"}};
  } else if constexpr (std::is_enum_v<T>) {
    Json names = Json::array();
    for (const T each : every<T>()) names.push_back(std::string(to_string(each)));
    return {{"enum", std::move(names)}};
  } else if constexpr (std::same_as<T, Range>) {
    return {{"type", "array"}, {"items", schema_of<double>()}, {"minItems", 2}, {"maxItems", 2}};
  } else if constexpr (std::same_as<T, Eigen::MatrixXd>) {
    return schema_of<std::vector<std::vector<double>>>();
  } else if constexpr (is_a<T, Omittable>) {
    return schema_of<typename T::value_type>();
  } else if constexpr (is_a<T, std::optional>) {
    Json schema = schema_of<typename T::value_type>();
    if (schema.contains("enum")) {
      schema["enum"].push_back(nullptr);
    } else if (schema.contains("type") && schema["type"].is_string()) {
      schema["type"] = Json::array({schema["type"], "null"});
    }
    return schema;
  } else if constexpr (is_keyed<T>) {
    return {{"type", "object"},
            {"additionalProperties", schema_of<typename T::value_type::second_type>()}};
  } else if constexpr (is_a<T, std::vector>) {
    return {{"type", "array"}, {"items", schema_of<typename T::value_type>()}};
  } else if constexpr (is_array<T>) {
    const std::size_t size = std::tuple_size_v<T>;
    return {{"type", "array"},
            {"items", schema_of<typename T::value_type>()},
            {"minItems", size},
            {"maxItems", size}};
  } else {
    static_assert(Struct<T>);
    Json properties = Json::object();
    Json required = Json::array();
    const T sample{};
    T::describe(sample, [&]<typename M>(const char* name, const M& /*member*/) {
      if constexpr (is_a<M, Columns>) {
        const Json row = schema_of<typename M::value_type>();
        for (const auto& [key, schema] : row["properties"].items())
          properties[key] = {{"type", "object"}, {"additionalProperties", schema}};
        for (const Json& key : row["required"]) required.push_back(key);
      } else {
        const std::string key = key_of(name);
        properties[key] = schema_of<M>();
        if constexpr (!may_be_missing<M>) required.push_back(key);
      }
    });
    return {{"type", "object"},
            {"properties", std::move(properties)},
            {"required", std::move(required)}};
  }
}

}  // namespace rigcal::report
