#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <optional>
#include <string>
#include <variant>

#include "calib/search/fit_options.hpp"
#include "common/describe.hpp"
#include "python/types.hpp"

namespace rigcal::python {

/// What a fit reports to its `progress` about one iteration.
struct Iteration {
  int start = 1;      ///< number of the start, counted from 1
  int iteration = 0;  ///< number of the iteration in this call of the solver, counted from 0
  double cost = 0.0;  ///< half the sum of squared weighted residuals
  double relative_change = 0.0;  ///< change in the cost; below zero, the step was rejected
  RIGCAL_DESCRIBE(start, iteration, cost, relative_change)
};

/// What a job reports to its `progress` about other work, such as the bootstrap.
struct Pieces {
  std::string work;  ///< "replicates of the bootstrap" and the like
  int done = 0;      ///< number of pieces that are done
  int all = 0;       ///< number of all pieces
  RIGCAL_DESCRIBE(work, done, all)
};

/// The function that a fit, or another job, reports to.
using FitProgress = std::optional<Callback<std::variant<Iteration, Pieces>>>;
using JobProgress = std::optional<Callback<Pieces>>;

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
