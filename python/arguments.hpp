#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/run/fit_choices.hpp"

namespace rigcal::python {

/// Whatever Python takes for a whole number: int, numpy.int64... Converted by whole_number(), so
/// that one out of range is a ValueError that names the argument.
struct Integer {
  pybind11::object value;
};

/// @throws pybind11::value_error  names the argument, what was found and what was expected
std::uint64_t whole_number(const char* name, const Integer& integer, std::uint64_t lowest,
                           std::uint64_t highest);
int count(const char* name, const Integer& integer, int lowest, int highest);

/// A finite number above zero, or none.
///
/// @throws pybind11::value_error  naming the argument
std::optional<double> positive(const char* name, std::optional<double> value);

/// @throws pybind11::value_error  the path is empty, naming the argument
void require_path(const char* name, const std::optional<std::filesystem::path>& path);

/// Number of threads; by default as many as the machine has.
int thread_count(const std::optional<Integer>& threads);

/// name="value unit" of each entry of a dict.
///
/// @throws pybind11::type_error  a value is neither text nor number
std::vector<std::string> assignments(const std::optional<pybind11::dict>& values);

/// Text that may contain a file name: bytes that are not UTF-8 are decoded like os.fsdecode().
pybind11::str decoded(std::string_view text);

/// Getter of a property that is a field of a member, or of its target if it is a pointer.
template <typename Self, typename Member, typename Value>
auto field(Member Self::*member, Value Member::*value) {
  return [=](const Self& self) { return (self.*member).*value; };
}
template <typename Self, typename Member, typename Value>
auto field(std::shared_ptr<const Member> Self::*member, Value Member::*value) {
  return [=](const Self& self) { return (*(self.*member)).*value; };
}

/// The same for an enumerator, as its name.
template <typename Self, typename Value>
auto named(Value Self::*value) {
  return [=](const Self& self) { return to_string(self.*value); };
}
template <typename Self, typename Member, typename Holder, typename Value>
auto named(Member Self::*member, Value Holder::*value) {
  return [get = field(member, value)](const Self& self) { return to_string(get(self)); };
}

/// "name=value" in Python's notation, for the call recorded in a result.
std::string written(const char* name, const pybind11::handle& value);

/// @throws pybind11::value_error  an argument is out of its range
report::FitChoices choices_of(const std::optional<Integer>& starts, const Integer& seed,
                              const Integer& bootstrap, bool profiles,
                              const std::optional<Integer>& posterior, bool cross_validate,
                              std::optional<double> max_time_s,
                              const std::optional<Integer>& max_evaluations);

}  // namespace rigcal::python

namespace pybind11::detail {

template <>
struct type_caster<rigcal::python::Integer> {
  PYBIND11_TYPE_CASTER(rigcal::python::Integer, const_name("int"));

  bool load(handle source, bool /*convert*/) {
    if (!source || PyIndex_Check(source.ptr()) == 0) return false;
    value.value = reinterpret_steal<object>(PyNumber_Index(source.ptr()));
    if (!value.value) PyErr_Clear();
    return static_cast<bool>(value.value);
  }

  static handle cast(const rigcal::python::Integer& source, return_value_policy /*policy*/,
                     handle /*parent*/) {
    return source.value.inc_ref();
  }
};

}  // namespace pybind11::detail
