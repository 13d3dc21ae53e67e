#include "model/signal/known_periods.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace rigcal::model {
namespace {

/// Samples [begin, begin + count) of a column.
auto part(std::span<double> column, std::size_t begin, std::size_t count) {
  return Eigen::Map<Eigen::ArrayXd>(column.data() + begin, static_cast<Eigen::Index>(count));
}
auto part(std::span<const double> column, std::size_t begin, std::size_t count) {
  return Eigen::Map<const Eigen::ArrayXd>(column.data() + begin, static_cast<Eigen::Index>(count));
}

}  // namespace

void continue_periods(const KnownPeriods& known, std::span<const double> multiples,
                      std::span<double> column) {
  for (std::size_t i = 0; i < multiples.size(); ++i) {
    const std::size_t begin = known.end + i * known.samples;
    const std::size_t count = std::min(known.samples, column.size() - begin);
    part(column, begin, count) = known.sign * part(column, begin - known.samples, count);
  }
  add_changes(known, multiples, column, column);
}

void add_changes(const KnownPeriods& known, std::span<const double> multiples,
                 std::span<const double> values, std::span<double> column) {
  const std::size_t last = known.end - known.samples;
  for (std::size_t i = 0; i < multiples.size(); ++i) {
    if (multiples[i] == 0.0) continue;
    const std::size_t begin = known.end + i * known.samples;
    const std::size_t count = std::min(known.samples, column.size() - begin);
    const double by = i % 2 == 0 ? known.sign * multiples[i] : multiples[i];
    part(column, begin, count) +=
        by * (part(values, last, count) - known.sign * part(values, last - known.samples, count));
  }
}

}  // namespace rigcal::model
