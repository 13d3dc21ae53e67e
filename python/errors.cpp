#include <pybind11/pybind11.h>

#include <exception>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "python/arguments.hpp"
#include "python/campaign.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;

/// Adapts a message from the command line, where options have dashes. In Python they are arguments:
/// "--set mass" becomes "set mass".
py::str without_dashes(std::string_view message) {
  if (message.starts_with("--")) message.remove_prefix(2);
  return decoded(message);
}

py::object known_or_none(long number) {
  return number > 0 ? py::object(py::int_(number)) : py::none();
}

void raise(const char* type, const py::tuple& arguments) {
  const py::object exception = py::module_::import("rigcal.errors").attr(type);
  const py::object value = exception(*arguments);
  PyErr_SetObject(exception.ptr(), value.ptr());
}

}  // namespace

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const InputError& error) {
      raise("InputError",
            py::make_tuple(decoded(error.what()), decoded(error.where().file),
                           known_or_none(error.where().line), known_or_none(error.where().column)));
    } catch (const UsageError& error) {
      raise("UsageError", py::make_tuple(without_dashes(error.what())));
    } catch (const NoResultError& error) {
      raise("NoResultError", py::make_tuple(decoded(error.what())));
    } catch (const WriteError& error) {
      raise("WriteError", py::make_tuple(decoded(error.what())));
    }
  });
}

}  // namespace rigcal::python
