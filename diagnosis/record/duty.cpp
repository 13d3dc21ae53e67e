#include "diagnosis/record/duty.hpp"

#include <utility>

namespace rigcal::diagnosis {
namespace {

using datasets::Condition;

bool is_sine(const Condition& condition) { return condition.waveform == datasets::Waveform::sine; }

std::pair<double, double> slowness(const Condition& condition) {
  return {-condition.frequency_hz.value_or(1e9), condition.amplitude.value_or(0.0)};
}

}  // namespace

std::optional<std::size_t> duty_among(const std::vector<const Condition*>& all,
                                      const std::string& wanted) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Condition& c = *all[i];
    if (!wanted.empty() && c.id == wanted) return i;
    if (!is_sine(c)) continue;
    const Condition& b = *all[best];
    if (!is_sine(b) || slowness(c) > slowness(b)) best = i;
  }
  return wanted.empty() ? std::optional(best) : std::nullopt;
}

}  // namespace rigcal::diagnosis
