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

/// Derivatives of mean_along_line() by a and by b.
struct LineSlopes {
  Extended by_a = 0.0L;
  Extended by_b = 0.0L;
};

LineSlopes slopes_along_line(Extended a, Extended b) {
  if (a * b >= 0.0L) {
    // If one end is zero, |y| grows with the sign of the other end.
    const Extended half = a + b < 0.0L ? -0.5L : 0.5L;
    return {half, half};
  }
  const Extended ends = std::abs(a) + std::abs(b);
  const Extended of_ends = 0.5L * (square(a) + square(b)) / square(ends);
  const Extended sign_a = a < 0.0L ? -1.0L : 1.0L;
  return {a / ends - of_ends * sign_a, b / ends + of_ends * sign_a};
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

std::vector<double> mean_absolute_weights(std::span<const double> time_s,
                                          std::span<const double> signal) {
  constexpr std::string_view kFunction = "mean_absolute_weights";
  check(time_s, signal, kFunction, "given");
  const Extended duration = wide(time_s.back()) - wide(time_s.front());
  std::vector<double> weights;
  weights.reserve(signal.size());
  Extended before = 0.0L;  // share of the line that ends at the sample
  for (std::size_t i = 0; i + 1 < signal.size(); ++i) {
    const Extended part = (wide(time_s[i + 1]) - wide(time_s[i])) / duration;
    const LineSlopes slopes = slopes_along_line(wide(signal[i]), wide(signal[i + 1]));
    weights.push_back(to_double(before + part * slopes.by_a, kFunction));
    before = part * slopes.by_b;
  }
  weights.push_back(to_double(before, kFunction));
  return weights;
}

double mean_absolute_slope(std::span<const double> time_s, std::span<const double> signal,
                           std::span<const double> slope) {
  constexpr std::string_view kFunction = "mean_absolute_slope";
  check(time_s, slope, kFunction, "slope");
  const std::vector<double> weights = mean_absolute_weights(time_s, signal);
  Extended sum = 0.0L;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += wide(weights[i]) * wide(slope[i]);
  return to_double(sum, kFunction);
}

}  // namespace rigcal::metrics
