#include "metrics/metric_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/significant.hpp"

namespace rigcal::metrics {

std::string score_text(const MetricSpec& metric, double score, const std::optional<double>& limit) {
  constexpr int kLeastDecimals = 4;
  constexpr int kMostDigits = 10;
  const bool is_fraction = metric.unit == "1" && metric.highest == 1.0;
  int digits = 4;
  if (is_fraction) {
    const double missing = std::abs(1.0 - score);
    digits = missing > 0.0 && std::isfinite(missing)
                 ? std::clamp(static_cast<int>(std::ceil(-std::log10(missing))) + 1, kLeastDecimals,
                              kMostDigits)
                 : kLeastDecimals;
  }
  const auto rounded = [&] {
    return std::strtod(
        (is_fraction ? fixed(score, digits) : fmt::format("{:.{}g}", score, digits)).c_str(),
        nullptr);
  };
  while (limit && digits < kMostDigits &&
         keeps(metric, rounded(), *limit) != keeps(metric, score, *limit))
    ++digits;
  return is_fraction ? fixed(score, digits) : significant(score, digits);
}

}  // namespace rigcal::metrics
