#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "datasets/synthetic/noise.hpp"

namespace rigcal::test {

using Samples = std::vector<double>;

/// Returns n samples of f(i), with i starting at 0.
template <typename Function>
Samples samples(std::size_t n, Function f) {
  Samples x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = f(static_cast<double>(i));
  return x;
}

/// Sine with amplitude 1 and `period` samples per period.
inline Samples sine_signal(std::size_t n, double period) {
  return samples(n, [&](double i) { return std::sin(2.0 * std::numbers::pi * i / period); });
}

/// Alternates between +1 and -1, each for half a period.
inline Samples square_signal(std::size_t n, double period) {
  return samples(n, [&](double i) { return std::fmod(i, period) < 0.5 * period ? 1.0 : -1.0; });
}

/// Response of a first-order lag with a time constant of `tau` samples.
inline Samples lagged(const Samples& drive, double tau) {
  Samples x;
  double state = 0.0;
  for (const double u : drive) {
    state += (u - state) * (1.0 - std::exp(-1.0 / tau));
    x.push_back(state);
  }
  return x;
}

inline Samples with_noise(Samples x, double sd, const std::string& name = "noise") {
  auto stream = datasets::random_stream(7, {name});
  for (double& value : x) value += datasets::normal(stream, sd);
  return x;
}

inline Samples quantised(Samples x, double step) {
  for (double& value : x) value = datasets::quantised(value, step);
  return x;
}

inline Samples clipped(Samples x, double low, double high) {
  for (double& value : x) value = std::clamp(value, low, high);
  return x;
}

}  // namespace rigcal::test
