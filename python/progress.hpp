#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <optional>
#include <string>

#include "calib/search/fit_options.hpp"

namespace rigcal::python {

/// What a fit tells of one iteration.
struct Iteration {
  int start = 1;
  int iteration = 0;
  double cost = 0.0;
  double relative_change = 0.0;
};

/// What a fit tells of the work beside it.
struct Pieces {
  std::string work;
  int done = 0;
  int all = 0;
};

/// Tells a function of Python how far a fit is, from whatever thread. What it raises ends the fit.
class Progress {
 public:
  /// @param cancel  becomes true when the function raises; borrowed
  Progress(std::optional<pybind11::function> function, std::atomic<bool>& cancel)
      : function_(std::move(function)), cancel_(cancel) {}

  /// Has the fit call this one, if there is a function.
  void attach(calib::FitOptions& settings);

  /// Throws what the function raised, if it did. With the interpreter's lock.
  void rethrow() const;

 private:
  template <typename Event>
  void tell(const Event& event);

  std::optional<pybind11::function> function_;
  std::atomic<bool>& cancel_;
  std::exception_ptr raised_;
};

}  // namespace rigcal::python
