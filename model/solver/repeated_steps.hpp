#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/solver/sampled_period.hpp"

namespace rigcal::model {

/// With periodic inputs, makes a step end at the same phase as a step one period earlier, if that
/// is close to the end that error control would choose. Steps that were rejected one period earlier
/// are not tried again, and two periods differ only in their states, not in their steps.
class RepeatedSteps {
 public:
  explicit RepeatedSteps(const std::optional<SampledPeriod>& period) {
    if (!period) return;
    period_s_ = period->duration_s;
    from_s_ = period->from_s;
  }

  struct Step {
    double size_s;
    bool forced;  ///< a longer step was rejected one period earlier
  };

  /// Returns the step to take at time t instead of the planned one.
  Step follow(double t, double planned);

  /// Records an accepted step.
  /// @param forced  a longer step was rejected, now or one period earlier
  void note(double t_new, bool forced) {
    if (std::isfinite(period_s_) && t_new >= from_s_) ends_.push_back({t_new, forced});
  }

 private:
  struct End {
    double t_s;
    bool forced;
  };

  double period_s_ = std::numeric_limits<double>::infinity();
  double from_s_ = 0.0;  ///< from when the inputs repeat
  std::vector<End> ends_;
  std::size_t next_ = 0;  ///< first step end that is less than a period ago
};

}  // namespace rigcal::model
