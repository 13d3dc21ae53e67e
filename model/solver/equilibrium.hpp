#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/arithmetic/inverse.hpp"
#include "model/plant/system.hpp"

namespace rigcal::model {

/// Moves a state to the point at which the rig settles while the inputs keep their values at the
/// first sample. Implicit Euler steps grow until they are Newton steps (pseudo-transient
/// continuation; Kelley and Keyes, 1998). In an open loop, the piston keeps its position and takes
/// the speed that its command causes. A quantity without a restoring effect, such as the mean
/// pressure behind edges that do not leak, also keeps its value. The sensitivities follow from the
/// implicit function theorem.
///
/// @param floor  size below which each state counts as zero
/// @return       false if the rig does not settle
template <typename Plant, int N, int P>
[[gnu::cold]] bool settle(const System<Plant, N, P>& system, const Values<N>& floor,
                          State<N, P>& x) {
  constexpr double kFirstStep_s = 1e-6;
  constexpr double kLastStep_s = 1e3;
  constexpr double kGrowth = 3.0;
  constexpr double kRise = 10.0;     // largest growth of the fastest rate in one step
  constexpr double kSettled = 1e-9;  // change of a state, relative to its size and floor
  constexpr int kMostSteps = 400;
  using Matrix = Eigen::Matrix<double, N, N>;
  const auto free = [&system](std::size_t i) {
    return system.layout().pid || i != static_cast<std::size_t>(Plant::position);
  };
  const auto linearised = [&](const Values<N>& at) { return system.linearise_settling(at, 0.0); };
  const auto rate = [&](const Linearisation<N, P>& lin) {
    double largest = 0.0;
    for (std::size_t i = 0; i < N; ++i)
      if (free(i)) largest = std::max(largest, std::abs(lin.f[i]) / floor[i]);
    return largest;
  };
  const auto inverse = [&](const Linearisation<N, P>& lin, double step_s) {
    Matrix matrix;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) {
        const double slope = free(i) ? lin.jacobian[i][k] * floor[k] / floor[i] : 0.0;
        matrix(static_cast<int>(i), static_cast<int>(k)) = (i == k ? 1.0 / step_s : 0.0) - slope;
      }
    }
    return inverse_of<N>(matrix);
  };

  Values<N> values = values_of(x);
  Linearisation<N, P> lin = linearised(values);
  double step_s = kFirstStep_s;
  bool settled = false;
  for (int steps = 0; !settled; ++steps) {
    if (steps == kMostSteps) return false;
    const Matrix by = inverse(lin, step_s);
    Values<N> next = values;
    double change = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      double moved = 0.0;
      for (std::size_t k = 0; k < N; ++k) {
        if (free(k)) moved += by(static_cast<int>(i), static_cast<int>(k)) * lin.f[k] / floor[k];
      }
      next[i] += moved * floor[i];
      change = std::max(change, std::abs(moved) * floor[i] / (floor[i] + std::abs(next[i])));
    }
    const Linearisation<N, P> there = linearised(next);
    if (!std::isfinite(change) || !(rate(there) <= kRise * rate(lin) + 1.0 / kLastStep_s)) {
      step_s /= kGrowth * kGrowth;
      if (step_s < 1e-6 * kFirstStep_s) return false;
      continue;
    }
    settled = step_s >= kLastStep_s && change <= kSettled;
    step_s = std::min(kGrowth * step_s, kLastStep_s);
    values = next;
    lin = there;
  }
  if constexpr (P == 0) {
    x = values;
  } else {
    const Matrix by = inverse(lin, kLastStep_s);
    Tangents<N, P> slopes{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) {
        const double scale = by(static_cast<int>(i), static_cast<int>(k)) * floor[i] / floor[k];
        slopes[i] = slopes[i] + x[k].derivative * (scale / kLastStep_s);
        if (free(k)) slopes[i] = slopes[i] + lin.f_p[k] * scale;
      }
    }
    for (std::size_t i = 0; i < N; ++i) {
      x[i].value = values[i];
      x[i].derivative = slopes[i];
    }
  }
  return true;
}

}  // namespace rigcal::model
