#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/describe.hpp"
#include "common/range.hpp"
#include "report/store/described_campaign.hpp"

// C++ types whose signatures name the exact type in Python. python/write_stub.py writes the stub
// from these signatures.

namespace rigcal::python {

/// An enumeration that Python receives as text. Its signature contains the C++ name, which the stub
/// replaces by the texts (see enumerations() in module.cpp).
template <typename T>
concept Named = std::is_enum_v<T> && requires(T value) {
  to_string(value);
};

/// A dict with keys and values of known types.
template <typename Key, typename Value>
struct Dict : pybind11::dict {
  using pybind11::dict::dict;
};

/// A function of the user that is called with an event.
template <typename Event>
struct Callback : pybind11::function {
  using pybind11::function::function;
};

/// Text as a template argument.
template <std::size_t kSize>
struct TypeName {
  char text[kSize]{};
  constexpr TypeName(const char (&from)[kSize]) {  // NOLINT(google-explicit-constructor)
    for (std::size_t i = 0; i < kSize; ++i) text[i] = from[i];
  }
};

/// A returned object whose type pybind11 does not know: Typed<"pandas.DataFrame">.
template <TypeName kName>
struct Typed : pybind11::object {
  Typed(pybind11::object value)  // NOLINT(google-explicit-constructor): a Python object itself
      : pybind11::object(std::move(value)) {}
  explicit Typed(const std::string& text) : pybind11::object(pybind11::str(text)) {}
};
using Frame = Typed<"pandas.DataFrame">;
using Figure = Typed<"matplotlib.figure.Figure">;
using JsonDict = Typed<"Dict[str, Any]">;

/// Converts pairs of key and value to a dict in the same order.
template <typename Value, typename Key>
Dict<std::string, Value> dict_of(const Keyed<Value, Key>& pairs) {
  Dict<std::string, Value> dict;
  for (const auto& [key, value] : pairs)
    dict[pybind11::str(report::described::key_text(key))] = value;
  return dict;
}

}  // namespace rigcal::python

namespace pybind11::detail {

template <typename Key, typename Value>
struct handle_type_name<rigcal::python::Dict<Key, Value>> {
  static constexpr auto name = const_name("Dict[") + make_caster<Key>::name + const_name(", ") +
                               make_caster<Value>::name + const_name("]");
};
template <typename Event>
struct handle_type_name<rigcal::python::Callback<Event>> {
  static constexpr auto name =
      const_name("Callable[[") + make_caster<Event>::name + const_name("], object]");
};
template <rigcal::python::TypeName kName>
struct handle_type_name<rigcal::python::Typed<kName>> {
  static constexpr auto name = const_name(kName.text);
};

template <rigcal::python::Named Enum>
class type_caster<Enum> {
 public:
  static constexpr auto name = const_name<Enum>();
  static handle cast(Enum value, return_value_policy /*policy*/, handle /*parent*/) {
    const std::string_view text = to_string(value);
    return str(text.data(), text.size()).release();
  }
};

template <rigcal::report::HasKeys Key>
class type_caster<Key> {
 public:
  static constexpr auto name = const_name("str");
  static handle cast(Key value, return_value_policy /*policy*/, handle /*parent*/) {
    const std::string_view text = rigcal::report::KeysOf<Key>::text(value);
    return str(text.data(), text.size()).release();
  }
};

/// The ends of an interval are a tuple in Python.
template <>
class type_caster<rigcal::Range> {
  using Ends = make_caster<std::pair<double, double>>;

 public:
  static constexpr auto name = Ends::name;
  static handle cast(const rigcal::Range& range, return_value_policy policy, handle parent) {
    return Ends::cast(std::pair(range.low, range.high), policy, parent);
  }
};

template <typename T>
class type_caster<rigcal::Omittable<T>> : public optional_caster<rigcal::Omittable<T>> {};
template <typename T>
class type_caster<rigcal::Later<T>> : public type_caster<T> {};

}  // namespace pybind11::detail
