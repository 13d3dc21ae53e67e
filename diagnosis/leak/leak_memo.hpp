#pragma once

#include <map>
#include <mutex>

#include "diagnosis/leak/leak_curve.hpp"

namespace rigcal::diagnosis {

/// Cache of simulated leaks for one condition, because its records all need the same ones. A
/// simulation may take a second if the rig approaches its periodic state slowly. Thread-safe.
class LeakMemo {
 public:
  /// Returns the leak for a coefficient, and simulates it on the first request.
  LeakPoint at(double coefficient, const LeakAt& simulate) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = points_.find(coefficient);
      if (found != points_.end()) return found->second;
    }
    const LeakPoint point = simulate(coefficient);
    const std::lock_guard lock(mutex_);
    return points_.emplace(coefficient, point).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<double, LeakPoint> points_;
};

}  // namespace rigcal::diagnosis
