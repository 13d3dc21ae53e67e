#include "model/solver/repeated_steps.hpp"

#include <algorithm>

namespace rigcal::model {
namespace {

// Limits relative to the planned step, whose expected error is two thirds of the allowed one. A
// longer step would be rejected, and a shorter one would be wasteful. After a rejection, a much
// shorter step is accepted, because the planned one would be rejected again.
constexpr double kLongest = 1.1;
constexpr double kShortest = 0.7;
constexpr double kShortestForced = 0.05;
// Two ends of steps a period apart are the same instant if they differ by less than this, relative
// to the step or to the time.
constexpr double kSame = 1e-6;
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

RepeatedSteps::Step RepeatedSteps::follow(double t, double planned) {
  const double ago = t - period_s_;
  const Step as_planned{planned, false};
  if (ago < 0.0) return as_planned;
  const double now = ago + std::max(kSame * planned, kRounding * t);
  while (next_ < ends_.size() && ends_[next_].t_s <= now) ++next_;
  // Takes the last end within reach, but does not skip one that was forced.
  const double reach = ago + kLongest * planned;
  std::size_t k = next_;
  while (k + 1 < ends_.size() && !ends_[k].forced && ends_[k + 1].t_s <= reach) ++k;
  if (k >= ends_.size() || ends_[k].t_s > reach) return as_planned;
  const Step repeated{ends_[k].t_s - ago, ends_[k].forced};
  const double shortest = repeated.forced ? kShortestForced : kShortest;
  return repeated.size_s < shortest * planned ? as_planned : repeated;
}

}  // namespace rigcal::model
