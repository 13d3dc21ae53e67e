#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/store/folder.hpp"

namespace rigcal::python {

/// The files of a result, in memory: what every verb but `fit` and `validate` returns, and what
/// these are pickled as.
struct Result {
  std::string kind;                       ///< "diagnosis"
  std::string name;                       ///< name of the campaign
  std::vector<report::ResultFile> files;  ///< without the page; the JSON comes last
  std::string text;                       ///< what the command prints
  std::vector<report::InputFile> inputs;
};
using ResultPtr = std::shared_ptr<Result>;

/// A page that a notebook shows.
struct Page {
  std::string html;
};

/// The live page of a campaign.
///
/// @param fitted  estimates in place of its values; may be empty
Page explore_page_of(const datasets::Campaign& campaign,
                     const std::vector<datasets::FittedValue>& fitted, const std::string& command);

/// What pickle stores of a result: the function that restores it, and its argument.
pybind11::tuple reduced(const ResultPtr& result);

/// A page as a frame of its own, so that its style and that of a notebook do not mix.
std::string frame_of(const std::string& page);

/// A function of rigcal/notebook.py, which imports pandas or matplotlib when it is called.
inline pybind11::object notebook(const char* name) {
  return pybind11::module_::import("rigcal.notebook").attr(name);
}
/// The same as a method without arguments.
inline auto of_notebook(const char* name) {
  return [name](const pybind11::object& self) { return notebook(name)(self); };
}

}  // namespace rigcal::python
