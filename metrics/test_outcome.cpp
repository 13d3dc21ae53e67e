#include "metrics/test_outcome.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rigcal::metrics {

Judged judge(bool rejects, const Power& power) {
  if (!(power.effective_samples >= kLeastEffectiveSamples)) {
    return {TestOutcome::not_judged,
            fmt::format("effective sample size {:.0f}, at least {:.0f} needed",
                        std::floor(power.effective_samples), kLeastEffectiveSamples)};
  }
  if (rejects) return {TestOutcome::failed, {}};
  if (!(power.bound <= power.largest_useful)) {
    return {TestOutcome::not_judged,
            fmt::format("{} below {:.2g} would not be detected (effective sample size {:.0f})",
                        power.effect, power.bound, std::floor(power.effective_samples))};
  }
  return {TestOutcome::passed, {}};
}

}  // namespace rigcal::metrics
