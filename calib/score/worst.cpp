#include "calib/score/worst.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rigcal::calib {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::infinity();

}  // namespace

void Badness::add(const LimitCheck& check) {
  const bool known = check.value && check.tolerance_used;
  tolerance_used = std::max(tolerance_used, known ? *check.tolerance_used : kNoValue);
}

void Badness::add_rho2(double rho2) {
  disagreement = std::max(disagreement, std::isnan(rho2) ? kNoValue : 1.0 - rho2);
}

Badness badness(const ConditionResult& condition, std::string_view channel) {
  Badness found{condition.failure || condition.not_scored,
                channel.empty() ? condition.verdict : condition.verdict_of(channel)};
  for (const LimitCheck& check : condition.limit_checks)
    if (channel.empty() || datasets::info(check.channel).key == channel) found.add(check);
  for (const ChannelScore& score : condition.channels)
    if (channel.empty() || score.key() == channel) found.add_rho2(score.metrics.rho2);
  return found;
}

bool shown_before(datasets::Use use_a, const Badness& a, datasets::Use use_b, const Badness& b) {
  const auto kind = [](datasets::Use use, const Badness& each) {
    return std::tuple(each.unusable || each.verdict == Verdict::fail,
                      use == datasets::Use::validate);
  };
  if (kind(use_a, a) != kind(use_b, b)) return kind(use_b, b) < kind(use_a, a);
  return b < a;
}

}  // namespace rigcal::calib
