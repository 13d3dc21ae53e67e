#include "model/known_periods.hpp"

#include <algorithm>

namespace rigcal::model {

void continue_periods(const KnownPeriods& known, std::span<const double> share,
                      std::span<double> column) {
  for (std::size_t i = 0; i < share.size(); ++i) {
    const std::size_t begin = known.end + i * known.samples;
    const std::size_t count = std::min(known.samples, column.size() - begin);
    std::copy_n(column.data() + (known.end - known.samples), count, column.data() + begin);
  }
  add_changes(known, share, column, column);
}

void add_changes(const KnownPeriods& known, std::span<const double> share,
                 std::span<const double> values, std::span<double> column) {
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (share[i] == 0.0) continue;
    const std::size_t begin = known.end + i * known.samples;
    const std::size_t count = std::min(known.samples, column.size() - begin);
    const double* last = values.data() + (known.end - known.samples);
    const double* before = last - known.samples;
    for (std::size_t k = 0; k < count; ++k) column[begin + k] += (last[k] - before[k]) * share[i];
  }
}

}  // namespace rigcal::model
