#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rigcal::datasets {

/// Returns the median of at least one value. For an even number of values it is the mean of the
/// middle two.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace rigcal::datasets
