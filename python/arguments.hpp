#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::python {

/// Whatever Python takes for a whole number: int, numpy.int64... One that is too large or negative
/// is to be a ValueError that names the argument, so that it is converted later.
struct Integer {
  pybind11::object value;
};

/// @throws pybind11::value_error  naming the argument, what was found and what was expected
std::uint64_t whole_number(const char* name, const Integer& integer, std::uint64_t lowest,
                           std::uint64_t highest);
int count(const char* name, const Integer& integer, int lowest, int highest);

/// A finite number above zero, or none.
///
/// @throws pybind11::value_error  naming the argument
std::optional<double> positive(const char* name, std::optional<double> value);

/// Threads: as many as the machine has, unless told.
int thread_count(const std::optional<Integer>& threads);

/// name="value unit" of each entry of a dict.
///
/// @throws pybind11::type_error  a value is no text and no number
std::vector<std::string> assignments(const std::optional<pybind11::dict>& values);

/// Text that may hold the name of a file: bytes that are no UTF-8 as os.fsdecode() writes them.
pybind11::str decoded(std::string_view text);

/// "name=value" as Python writes it, for the call that a result was made by.
std::string written(const char* name, const pybind11::handle& value);

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
