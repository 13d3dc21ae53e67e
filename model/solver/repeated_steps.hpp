#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/signal/sampled_period.hpp"

namespace rigcal::model {

/// With periodic inputs a step ends where one ended a period ago, if that is close to the choice of
/// the error control. Steps that were rejected a period ago are not tried again, and two periods
/// differ only by their states, not by their steps.
class RepeatedSteps {
 public:
  explicit RepeatedSteps(const std::optional<SampledPeriod>& period) {
    if (period) period_s_ = period->duration_s;
  }

  struct Step {
    double size_s;
    bool forced;  ///< a longer one was rejected a period ago
  };

  /// The step to take at time t in place of the one planned.
  Step follow(double t, double planned);

  /// A step was accepted.
  /// @param forced  a longer one was rejected, now or a period ago
  void note(double t_new, bool forced) {
    if (std::isfinite(period_s_)) ends_.push_back({t_new, forced});
  }

 private:
  struct End {
    double t_s;
    bool forced;
  };

  double period_s_ = std::numeric_limits<double>::infinity();
  std::vector<End> ends_;
  std::size_t next_ = 0;  ///< the first that ended later than a period ago
};

}  // namespace rigcal::model
