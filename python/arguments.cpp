#include "python/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace rigcal::python {

namespace py = pybind11;

std::uint64_t whole_number(const char* name, const Integer& integer, std::uint64_t lowest,
                           std::uint64_t highest) {
  static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
  const std::uint64_t value = PyLong_AsUnsignedLongLong(integer.value.ptr());
  const bool beyond = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  if (beyond || value < lowest || value > highest) {
    throw py::value_error(fmt::format("{}: found {}, expected a whole number from {} to {}", name,
                                      std::string(py::str(integer.value)), lowest, highest));
  }
  return value;
}

int count(const char* name, const Integer& integer, int lowest, int highest) {
  return static_cast<int>(whole_number(name, integer, static_cast<std::uint64_t>(lowest),
                                       static_cast<std::uint64_t>(highest)));
}

std::optional<double> positive(const char* name, std::optional<double> value) {
  if (value && !(std::isfinite(*value) && *value > 0.0)) {
    throw py::value_error(
        fmt::format("{}: found {}, expected a finite number above zero", name, *value));
  }
  return value;
}

void require_path(const char* name, const std::optional<std::filesystem::path>& path) {
  if (path && path->empty()) throw py::value_error(fmt::format("{}: found an empty path", name));
}

int thread_count(const std::optional<Integer>& threads) {
  if (threads) return count("threads", *threads, 1, report::kMostThreads);
  const unsigned found = std::thread::hardware_concurrency();
  return std::clamp(static_cast<int>(found), 1, report::kMostThreads);
}

std::vector<std::string> assignments(
    const std::optional<Dict<std::string, std::variant<std::string, double>>>& values) {
  std::vector<std::string> texts;
  if (!values) return texts;
  for (const auto& [name, value] : *values) {
    if (!py::isinstance<py::str>(name) ||
        !(py::isinstance<py::str>(value) || PyNumber_Check(value.ptr()) != 0)) {
      throw py::type_error(fmt::format("set: found {}: {}, expected a name with \"value unit\"",
                                       std::string(py::repr(name)), std::string(py::repr(value))));
    }
    texts.push_back(std::string(py::str(name)) + "=" + std::string(py::str(value)));
  }
  return texts;
}

py::str decoded(std::string_view text) {
  PyObject* const object =
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape");
  if (object == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(object);
}

std::string written(const char* name, const py::handle& value) {
  return fmt::format("{}={}", name, std::string(py::repr(value)));
}

report::FitChoices choices_of(const std::optional<Integer>& starts, const Integer& seed,
                              const Integer& bootstrap, bool profiles,
                              const std::optional<Integer>& posterior, bool cross_validate,
                              std::optional<double> max_time_s,
                              const std::optional<Integer>& max_evaluations) {
  report::FitChoices choices;
  if (starts) choices.starts = count("starts", *starts, 1, report::kMostStarts);
  choices.seed = whole_number("seed", seed, 0, std::numeric_limits<std::uint64_t>::max());
  choices.bootstrap = count("bootstrap", bootstrap, 0, report::kMostReplicates);
  choices.profiles = profiles;
  if (posterior) {
    choices.posterior = count("posterior", *posterior, datasets::kLeastPosteriorDraws,
                              datasets::kMostPosteriorDraws);
  }
  choices.cross_validate = cross_validate;
  choices.max_time_s = positive("max_time", max_time_s);
  if (max_evaluations) {
    choices.max_evaluations = static_cast<long>(
        whole_number("max_evaluations", *max_evaluations, 1, std::numeric_limits<long>::max()));
  }
  return choices;
}

}  // namespace rigcal::python
