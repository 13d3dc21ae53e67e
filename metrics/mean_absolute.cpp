#include "metrics/mean_absolute.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "metrics/moments.hpp"

namespace rigcal::metrics {
namespace {

/// Mean of |y| along a straight line from a to b.
Extended mean_along_line(Extended a, Extended b) {
  const Extended ends = std::abs(a) + std::abs(b);
  if (a * b >= 0.0L) return 0.5L * ends;
  return 0.5L * (square(a) + square(b)) / ends;
}

/// Derivative of mean_along_line() when a and b change by da and db.
Extended slope_along_line(Extended a, Extended b, Extended da, Extended db) {
  const Extended sign_a = a < 0.0L ? -1.0L : 1.0L;
  const Extended sign_b = b < 0.0L ? -1.0L : 1.0L;
  const Extended d_ends = sign_a * da + sign_b * db;
  if (a * b >= 0.0L) {
    // If one end is zero, |y| grows with the sign of the other end.
    const Extended sign = a + b < 0.0L ? -1.0L : 1.0L;
    return 0.5L * sign * (da + db);
  }
  const Extended ends = std::abs(a) + std::abs(b);
  return (a * da + b * db) / ends - 0.5L * (square(a) + square(b)) / square(ends) * d_ends;
}

void check(std::span<const double> time_s, std::span<const double> signal,
           std::string_view function, std::string_view name) {
  if (time_s.size() != signal.size()) {
    throw std::invalid_argument(fmt::format("{}: {} times but {} samples of the {} signal",
                                            function, time_s.size(), signal.size(), name));
  }
  require_increasing(time_s, function);
  finite_range(signal, function, name);
}

}  // namespace

double mean_absolute(std::span<const double> time_s, std::span<const double> signal) {
  constexpr std::string_view kFunction = "mean_absolute";
  check(time_s, signal, kFunction, "given");
  const std::size_t lines = signal.size() - 1;
  const auto line = [&](std::size_t i) {
    return (wide(time_s[i + 1]) - wide(time_s[i])) *
           mean_along_line(wide(signal[i]), wide(signal[i + 1]));
  };
  const Extended duration = wide(time_s.back()) - wide(time_s.front());
  return to_double(mean_of(lines, line) * static_cast<Extended>(lines) / duration, kFunction);
}

double mean_absolute_slope(std::span<const double> time_s, std::span<const double> signal,
                           std::span<const double> slope) {
  constexpr std::string_view kFunction = "mean_absolute_slope";
  check(time_s, signal, kFunction, "given");
  check(time_s, slope, kFunction, "slope");
  const std::size_t lines = signal.size() - 1;
  const auto line = [&](std::size_t i) {
    return (wide(time_s[i + 1]) - wide(time_s[i])) *
           slope_along_line(wide(signal[i]), wide(signal[i + 1]), wide(slope[i]),
                            wide(slope[i + 1]));
  };
  const Extended duration = wide(time_s.back()) - wide(time_s.front());
  return to_double(mean_of(lines, line) * static_cast<Extended>(lines) / duration, kFunction);
}

}  // namespace rigcal::metrics
