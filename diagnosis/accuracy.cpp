#include "diagnosis/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {

Confusion::Confusion() {
  for (std::size_t i = 0; i < kClasses; ++i)
    truth[i] = found[i] = to_string(datasets::kLeakClasses[i]);
  found.back() = "undecided";
}

Accuracy accuracy_of(const std::vector<Judged>& judged) {
  Accuracy result;
  std::set<std::string> conditions;
  for (const Judged& each : judged) {
    const auto row = static_cast<std::size_t>(each.truth);
    const auto column =
        each.found ? static_cast<std::size_t>(*each.found) : datasets::kLeakClasses.size();
    ++result.confusion.counts[row][column];
    ++result.records;
    conditions.insert(each.condition);
    if (!each.found) {
      ++result.undecided;
    } else if (row == column) {
      ++result.right;
    } else if (std::max(row, column) - std::min(row, column) >= 2) {
      ++result.off_by_two_or_more;
    }
  }
  result.conditions = static_cast<int>(conditions.size());
  if (result.records == 0) return result;
  result.accuracy = static_cast<double>(result.right) / result.records;
  result.accuracy_ci95 = wilson_interval(*result.accuracy, result.conditions);
  return result;
}

Range wilson_interval(double proportion, double trials) {
  const double z = metrics::normal_quantile(0.975);
  const double z2 = z * z;
  const double centre = proportion + z2 / (2.0 * trials);
  const double half =
      z * std::sqrt(proportion * (1.0 - proportion) / trials + z2 / (4.0 * trials * trials));
  const double scale = 1.0 + z2 / trials;
  return {std::max(0.0, (centre - half) / scale), std::min(1.0, (centre + half) / scale)};
}

}  // namespace rigcal::diagnosis
