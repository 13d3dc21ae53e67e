#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>

#include "report/store/folder.hpp"

namespace rigcal::python {

/// Describes how a call may use its output folder. Messages become a UserWarning.
inline report::Holding holding(std::string verb, bool force) {
  return {std::move(verb), force, "force=True", [](const std::string& text) {
            const pybind11::gil_scoped_acquire acquired;
            if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0)
              throw pybind11::error_already_set();
          }};
}

}  // namespace rigcal::python
