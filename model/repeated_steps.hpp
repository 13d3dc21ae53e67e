#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/sampled_period.hpp"

namespace rigcal::model {

/// Where inputs are periodic, a step ends where one ended a period ago if that is about as far as
/// the error control would go. So nothing is tried again that was rejected a period ago, and two
/// periods differ by what the states do, not by where the steps happen to end.
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
  Step follow(double t, double planned) {
    const double ago = t - period_s_;
    const Step as_planned{planned, false};
    if (ago < 0.0) return as_planned;
    const double now = ago + std::max(kSame * planned, kRounding * t);
    while (next_ < ends_.size() && ends_[next_].t_s <= now) ++next_;
    // The last end within reach, but not beyond one that was forced.
    const double reach = ago + kLongest * planned;
    std::size_t k = next_;
    while (k + 1 < ends_.size() && !ends_[k].forced && ends_[k + 1].t_s <= reach) ++k;
    if (k >= ends_.size() || ends_[k].t_s > reach) return as_planned;
    const Step repeated{ends_[k].t_s - ago, ends_[k].forced};
    const double shortest = repeated.forced ? kShortestForced : kShortest;
    return repeated.size_s < shortest * planned ? as_planned : repeated;
  }

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
  /// Over the step planned, whose error would be two thirds of what is allowed.
  static constexpr double kLongest = 1.1;
  static constexpr double kShortest = 0.7;
  static constexpr double kShortestForced = 0.05;
  static constexpr double kSame = 1e-6;
  static constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();

  double period_s_ = std::numeric_limits<double>::infinity();
  std::vector<End> ends_;
  std::size_t next_ = 0;  ///< the first that ended later than a period ago
};

}  // namespace rigcal::model
