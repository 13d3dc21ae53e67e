#pragma once

#include <map>
#include <mutex>

#include "diagnosis/leak/leak_curve.hpp"

namespace rigcal::diagnosis {

/// Leaks of one condition that were simulated: its records ask for the same ones, and each takes a
/// second where the rig is slow to become periodic. Thread-safe.
class LeakMemo {
 public:
  /// That of the coefficient; simulated where nobody has asked for it.
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
