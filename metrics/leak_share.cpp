#include "metrics/leak_share.hpp"

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

Extended checked_mean(std::span<const double> time_s, std::span<const double> signal,
                      std::string_view function, std::string_view name) {
  if (time_s.size() != signal.size()) {
    throw std::invalid_argument(fmt::format("{}: {} times but {} samples of the {} signal",
                                            function, time_s.size(), signal.size(), name));
  }
  finite_range(time_s, function, "time");
  finite_range(signal, function, name);
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1])) {
      throw std::invalid_argument(fmt::format("{}: time[{}] = {} does not come after {}", function,
                                              i, time_s[i], time_s[i - 1]));
    }
  }
  const std::size_t lines = signal.size() - 1;
  const auto line = [&](std::size_t i) {
    return (wide(time_s[i + 1]) - wide(time_s[i])) *
           mean_along_line(wide(signal[i]), wide(signal[i + 1]));
  };
  const Extended duration = wide(time_s.back()) - wide(time_s.front());
  return mean_of(lines, line) * static_cast<Extended>(lines) / duration;
}

}  // namespace

double mean_absolute(std::span<const double> time_s, std::span<const double> signal) {
  return to_double(checked_mean(time_s, signal, "mean_absolute", "given"), "mean_absolute");
}

double leak_share(std::span<const double> time_s, std::span<const double> servo_flow,
                  std::span<const double> leakage_flow) {
  constexpr std::string_view kFunction = "leak_share";
  const Extended servo = checked_mean(time_s, servo_flow, kFunction, "servo flow");
  const Extended leak = checked_mean(time_s, leakage_flow, kFunction, "leakage flow");
  if (servo == 0.0L) {
    throw std::domain_error("leak_share: the servo flow is zero throughout, so there is no share");
  }
  return to_double(leak / servo, kFunction);
}

}  // namespace rigcal::metrics
