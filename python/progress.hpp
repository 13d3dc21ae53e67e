#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <optional>
#include <string>

#include "calib/search/fit_options.hpp"

namespace rigcal::python {

/// Progress of one iteration.
struct Iteration {
  int start = 1;
  int iteration = 0;
  double cost = 0.0;
  double relative_change = 0.0;
};

/// Progress of the other parts of a fit, such as the bootstrap.
struct Pieces {
  std::string work;
  int done = 0;
  int all = 0;
};

/// Reports the progress of a fit to a Python function from any thread. If the function raises an
/// exception, the fit ends.
class Progress {
 public:
  /// @param cancel  set to true when the function raises; borrowed
  Progress(std::optional<pybind11::function> function, std::atomic<bool>& cancel)
      : function_(std::move(function)), cancel_(cancel) {}

  /// Makes the fit report to this object, if there is a function.
  void attach(calib::FitOptions& settings);

  /// Reports how many pieces of a job are done, if there is a function.
  void pieces(const char* work, int done, int all);

  /// Throws the exception that the function raised, if any. The caller must hold the GIL.
  void rethrow() const;

 private:
  template <typename Event>
  void tell(const Event& event);

  std::optional<pybind11::function> function_;
  std::atomic<bool>& cancel_;
  std::exception_ptr raised_;
};

}  // namespace rigcal::python
