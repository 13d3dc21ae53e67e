#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace rigcal::bench {

/// CPU time of this process over all threads [ms].
inline double cpu_ms() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Middle value; for an even number of values, the larger of the two in the middle.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace rigcal::bench
