#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "calib/consider/effect_changes.hpp"
#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// What the effects do to a rig without a leak. Conditions with the same signal differ only in the
/// leak, so they share these simulations. Thread-safe; what it returns does not depend on the order
/// of requests.
class HealthyEffects {
 public:
  using Changes = std::shared_ptr<const calib::EffectChanges>;

  /// Returns the result of `simulate`, or the stored result of a condition with the same
  /// simulation.
  ///
  /// @param values  parameter values without a leak
  /// @param acting  effects that act in the condition
  Changes of(const calib::ProblemCondition& condition, const model::ParameterValues& values,
             const std::vector<calib::Effect>& acting,
             const std::function<calib::EffectChanges()>& simulate);

 private:
  struct Known {
    datasets::Condition condition;
    model::Rig rig;
    model::ParameterValues values;
    double drive_begins_s = 0.0;
    std::vector<double> time_s;
    std::vector<model::Output> outputs;
    std::vector<calib::Effect> acting;
    Changes changes;

    bool serves(const Known& other) const;
  };

  std::mutex mutex_;
  std::vector<Known> known_;
};

}  // namespace rigcal::diagnosis
