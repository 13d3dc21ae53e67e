#pragma once

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>

#include <exception>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Reports each iteration of Ceres, and stops Ceres on request. Exceptions must not pass through
/// Ceres. If the callback throws, the exception is stored and Ceres stops; the caller rethrows it.
class CeresWatch final : public ceres::IterationCallback {
 public:
  CeresWatch(const std::function<bool(const DescentStep&)>& enough, std::exception_ptr& error)
      : enough_(enough), error_(error) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    made_ = summary.iteration;
    bool stop = false;
    try {
      stop = enough_ && enough_({made_, summary.cost,
                                 summary.cost > 0.0 ? summary.cost_change / summary.cost : 0.0,
                                 summary.cumulative_time_in_seconds});
    } catch (...) {
      error_ = std::current_exception();
    }
    return stop || error_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  int made() const { return made_; }

 private:
  const std::function<bool(const DescentStep&)>& enough_;
  std::exception_ptr& error_;
  int made_ = 0;
};

inline ceres::Solver::Options quiet_settings() {
  ceres::Solver::Options settings;
  settings.num_threads = 1;  // keeps the order of sums; the simulations themselves run in parallel
  settings.logging_type = ceres::SILENT;
  settings.minimizer_progress_to_stdout = false;
  return settings;
}

}  // namespace rigcal::calib
