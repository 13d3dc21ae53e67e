#include "metrics/moments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace rigcal::metrics {

Range finite_range(std::span<const double> signal, std::string_view function,
                   std::string_view name) {
  if (signal.size() < 2)
    throw std::invalid_argument(fmt::format("{}: the {} signal has {} samples, expected at least 2",
                                            function, name, signal.size()));
  Range range{signal.front(), signal.front()};
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (!std::isfinite(signal[i]))
      throw std::invalid_argument(
          fmt::format("{}: {}[{}] is {}, expected a finite value", function, name, i, signal[i]));
    range.low = std::min(range.low, signal[i]);
    range.high = std::max(range.high, signal[i]);
  }
  return range;
}

void require_increasing(std::span<const double> time_s, std::string_view function) {
  finite_range(time_s, function, "time_s");
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1]))
      throw std::invalid_argument(
          fmt::format("{}: time_s[{}] is {} after {}, expected increasing times", function, i,
                      time_s[i], time_s[i - 1]));
  }
}

double to_double(Extended value, std::string_view function) {
  if (std::abs(value) > wide(std::numeric_limits<double>::max()))
    throw std::domain_error(fmt::format("{}: the result is beyond the largest double", function));
  return static_cast<double>(value);
}

}  // namespace rigcal::metrics
