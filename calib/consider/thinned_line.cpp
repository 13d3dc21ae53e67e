#include "calib/consider/thinned_line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rigcal::calib {

model::Signal thinned_line(std::span<const double> time_s, std::span<const double> value) {
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  const double tolerance = kThinnedError * (*high - *low);
  std::vector<double> times{time_s.front()};
  std::vector<double> values{value.front()};
  // Slopes between which a line from the last kept sample is close enough to all samples since.
  double least = -HUGE_VAL;
  double most = HUGE_VAL;
  const auto slope_to = [&](std::size_t i, double off) {
    return (value[i] + off - values.back()) / (time_s[i] - times.back());
  };
  for (std::size_t i = 1; i < value.size(); ++i) {
    const double slope = slope_to(i, 0.0);
    if (!(slope >= least && slope <= most)) {
      times.push_back(time_s[i - 1]);
      values.push_back(value[i - 1]);
      least = -HUGE_VAL;
      most = HUGE_VAL;
    }
    least = std::max(least, slope_to(i, -tolerance));
    most = std::min(most, slope_to(i, tolerance));
  }
  if (value.size() > 1) {
    times.push_back(time_s.back());
    values.push_back(value.back());
  }
  return model::Signal::linear(std::move(times), std::move(values));
}

}  // namespace rigcal::calib
