#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "python/types.hpp"
#include "report/store/folder.hpp"

namespace rigcal::python {

/// The files of a result in memory. Every verb except `fit` and `validate` returns this class, and
/// fits and validations are pickled as one.
struct Result {
  std::string kind;                       ///< for example "diagnosis"
  std::string name;                       ///< name of the campaign
  std::vector<report::ResultFile> files;  ///< all files except the page; the JSON file comes last
  std::string text;                       ///< the text that the command would print
  std::vector<report::InputFile> inputs;
};
using ResultPtr = std::shared_ptr<Result>;

/// Describes how a call may use its output folder. Messages become a UserWarning.
inline report::Holding holding(std::string verb, bool force) {
  return {std::move(verb), force, "force=True", [](const std::string& text) {
            const pybind11::gil_scoped_acquire acquired;
            if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0)
              throw pybind11::error_already_set();
          }};
}

/// A page for display in a notebook.
struct Page {
  std::string html;
};

/// Makes the live page of a campaign.
///
/// @param fitted  estimates that replace the campaign's values; may be empty
Page explore_page_of(const datasets::Campaign& campaign,
                     const std::vector<datasets::FittedValue>& fitted, const std::string& command);

/// Returns what pickle stores for a result: the function that restores it, and its argument.
pybind11::tuple reduced(const ResultPtr& result);

/// Wraps a page in a frame, so that its style and that of the notebook do not interfere.
std::string frame_of(const std::string& page);

/// Returns a function from rigcal/notebook.py. The function imports pandas or matplotlib only when
/// it is called.
inline pybind11::object notebook(const char* name) {
  return pybind11::module_::import("rigcal.notebook").attr(name);
}
/// Returns a method without arguments that calls a function from rigcal/notebook.py.
template <typename Returned>
auto of_notebook(const char* name) {
  return [name](const pybind11::object& self) { return Returned(notebook(name)(self)); };
}

}  // namespace rigcal::python
