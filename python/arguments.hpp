#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "python/types.hpp"
#include "report/run/fit_choices.hpp"

namespace rigcal::python {

/// Any object that Python accepts as a whole number: int, numpy.int64 and so on. whole_number()
/// converts it, so that a value out of range raises a ValueError that names the argument.
struct Integer {
  pybind11::object value;
};

/// Converts and checks a whole number.
///
/// @throws pybind11::value_error  if the value is out of range; names the argument, what was found
///                                and what was expected
std::uint64_t whole_number(const char* name, const Integer& integer, std::uint64_t lowest,
                           std::uint64_t highest);
int count(const char* name, const Integer& integer, int lowest, int highest);

/// Checks that a number is finite and positive, if it is given.
///
/// @throws pybind11::value_error  if it is not; names the argument
std::optional<double> positive(const char* name, std::optional<double> value);

/// @throws pybind11::value_error  if the path is empty; names the argument
void require_path(const char* name, const std::optional<std::filesystem::path>& path);

/// Returns the number of threads. The default is the number of hardware threads.
int thread_count(const std::optional<Integer>& threads);

/// Converts each entry of a dict to name="value unit".
///
/// @throws pybind11::type_error  if a value is neither text nor a number
std::vector<std::string> assignments(
    const std::optional<Dict<std::string, std::variant<std::string, double>>>& values);

/// Converts text that may contain a file name. Bytes that are not UTF-8 are decoded as by
/// os.fsdecode().
pybind11::str decoded(std::string_view text);

/// Returns a getter for a property that is a field of a member. The member may be a pointer, and
/// the field one of its base.
template <typename Self, typename Member, typename Value>
auto field(Member Self::*member, Value Member::*value) {
  return [=](const Self& self) { return (self.*member).*value; };
}
template <typename Self, typename Member, typename Base, typename Value>
auto field(std::shared_ptr<const Member> Self::*member, Value Base::*value) {
  return [=](const Self& self) { return (*(self.*member)).*value; };
}

/// Formats "name=value" in Python notation, for the call recorded in a result.
std::string written(const char* name, const pybind11::handle& value);

/// The text of a call, such as ".diagnose(fit='fit.json', healthy=['0 %'])".
class CallText {
 public:
  explicit CallText(std::string name) : text_(std::move(name) + "(") {}
  void add(const std::string& argument) {
    text_ += (first_ ? "" : ", ") + argument;
    first_ = false;
  }
  template <typename T>
  void add(const char* name, const std::optional<T>& value) {
    if (value) add(written(name, pybind11::cast(*value)));
  }
  /// Leaves out a value that is the default.
  template <typename T>
  void add(const char* name, const T& value, const T& fallback) {
    if (value != fallback) add(written(name, pybind11::cast(value)));
  }
  std::string text() const { return text_ + ")"; }

 private:
  std::string text_;
  bool first_ = true;
};

/// @throws pybind11::value_error  if an argument is out of range
report::FitChoices choices_of(const std::optional<Integer>& starts, const Integer& seed,
                              const Integer& bootstrap, bool profiles,
                              const std::optional<Integer>& posterior, bool cross_validate,
                              std::optional<double> max_time_s,
                              const std::optional<Integer>& max_evaluations);

}  // namespace rigcal::python

namespace pybind11::detail {

template <>
struct type_caster<rigcal::python::Integer> {
  PYBIND11_TYPE_CASTER(rigcal::python::Integer, const_name("SupportsIndex"));

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
