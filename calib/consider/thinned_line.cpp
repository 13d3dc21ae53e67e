#include "calib/consider/thinned_line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rigcal::calib {
namespace {

double tolerance_for(std::span<const double> value) {
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  return kThinnedError * (*high - *low);
}

/// Returns the samples that a line needs to stay within the tolerance of all others, in order. The
/// first and the last are among them.
std::vector<std::size_t> needed(std::span<const double> time_s, std::span<const double> value,
                                double tolerance) {
  std::vector<std::size_t> kept{0};
  // Slopes between which a line from the last kept sample is close enough to all samples since.
  double least = -HUGE_VAL;
  double most = HUGE_VAL;
  const auto slope_to = [&](std::size_t i, double off) {
    return (value[i] + off - value[kept.back()]) / (time_s[i] - time_s[kept.back()]);
  };
  for (std::size_t i = 1; i < value.size(); ++i) {
    const double slope = slope_to(i, 0.0);
    if (!(slope >= least && slope <= most)) {
      kept.push_back(i - 1);
      least = -HUGE_VAL;
      most = HUGE_VAL;
    }
    least = std::max(least, slope_to(i, -tolerance));
    most = std::min(most, slope_to(i, tolerance));
  }
  if (value.size() > 1) kept.push_back(value.size() - 1);
  return kept;
}

}  // namespace

model::Signal thinned_line(std::span<const double> time_s, std::span<const double> value) {
  std::vector<double> times;
  std::vector<double> values;
  for (const std::size_t i : needed(time_s, value, tolerance_for(value))) {
    times.push_back(time_s[i]);
    values.push_back(value[i]);
  }
  return model::Signal::linear(std::move(times), std::move(values));
}

model::Signal repeating_line(std::span<const double> time_s, std::span<const double> value,
                             std::span<const model::SampledPeriod> periods, Reverses reverses) {
  const double tolerance = tolerance_for(value);
  for (const model::SampledPeriod& period : periods) {
    const std::size_t n = period.samples;
    const double sign = reverses == Reverses::yes ? period.sign() : 1.0;
    if (value.size() < 2 * n) continue;
    std::size_t from = value.size() - n;
    while (from > 0 && std::abs(value[from - 1 + n] - sign * value[from - 1]) <= tolerance) --from;
    if (from + 2 * n >= value.size()) continue;  // no period would be left out
    std::vector<double> times;
    std::vector<double> values;
    for (const std::size_t i : needed(time_s.first(from + 1), value.first(from + 1), tolerance)) {
      times.push_back(time_s[i]);
      values.push_back(value[i]);
    }
    std::vector<double> one(value.begin() + static_cast<std::ptrdiff_t>(from),
                            value.begin() + static_cast<std::ptrdiff_t>(from + n + 1));
    one.back() = sign * one.front();
    const std::vector<std::size_t> kept = needed(time_s.subspan(from, n + 1), one, tolerance);
    double now = 1.0;
    for (std::size_t first = from; first + 1 < value.size(); first += n, now *= sign) {
      for (const std::size_t i : kept) {
        if (i == 0 || first + i >= value.size()) continue;
        times.push_back(time_s[first + i]);
        values.push_back(now * one[i]);
      }
    }
    if (times.back() < time_s.back()) {
      times.push_back(time_s.back());
      values.push_back(value.back());
    }
    return model::Signal::linear(std::move(times), std::move(values),
                                 {time_s[from], period.duration_s, sign < 0.0});
  }
  return thinned_line(time_s, value);
}

}  // namespace rigcal::calib
