#include "datasets/checks/repeat_checks.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/checks/equal_runs.hpp"

namespace rigcal::datasets {
namespace {

/// Whether the values differ only by whole steps, within rounding, as those of a converter do.
bool on_a_grid(const std::vector<double>& values, double step) {
  constexpr double kOffGrid = 0.05;  // fraction of a step
  return std::all_of(values.begin(), values.end(), [&](double value) {
    const double multiple = (value - values.front()) / step;
    return std::abs(multiple - std::round(multiple)) <= kOffGrid;
  });
}

}  // namespace

std::vector<std::size_t> first_identical(const std::vector<Repeat>& repeats,
                                         const std::vector<std::size_t>& carriers,
                                         Channel channel) {
  std::vector<std::size_t> first(carriers.size());
  for (std::size_t k = 0; k < carriers.size(); ++k) {
    first[k] = k;
    const auto& own = repeats[carriers[k]].values.at(channel);
    if (!info(channel).is_output || is_constant(own)) continue;
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      if (repeats[carriers[earlier]].values.at(channel) != own) continue;
      first[k] = earlier;
      break;
    }
  }
  return first;
}

std::optional<double> coarse_step(const std::vector<Repeat>& repeats, Channel channel,
                                  double noise_sd) {
  // The noise is half a step, and the rounding error adds a variance of step^2 / 12.
  const double enough = std::sqrt(0.25 + 1.0 / 12.0);
  std::optional<double> coarsest;
  for (const Repeat& repeat : repeats) {
    const auto found = repeat.values.find(channel);
    if (found == repeat.values.end()) continue;
    const double step = resolution(equal_runs(found->second));
    if (!(noise_sd < enough * step) || !on_a_grid(found->second, step)) continue;
    coarsest = std::max(coarsest.value_or(0.0), step);
  }
  return coarsest;
}

}  // namespace rigcal::datasets
