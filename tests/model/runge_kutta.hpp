#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace rigcal::model {

/// Integrates x' = rates(x, t) by classical Runge-Kutta steps of equal length. It shares no code
/// with the solvers, so a test that states the equations for itself checks both.
///
/// @param x      state at the first time
/// @param steps  number of steps between two times
/// @return       shape (times, N)
template <std::size_t N, typename Rates>
Eigen::MatrixXd runge_kutta(std::array<double, N> x, std::span<const double> times_s, int steps,
                            const Rates& rates) {
  using Point = std::array<double, N>;
  const auto moved = [](const Point& from, const Point& rate, double by) {
    Point to = from;
    for (std::size_t i = 0; i < N; ++i) to[i] += by * rate[i];
    return to;
  };
  Eigen::MatrixXd result(static_cast<Eigen::Index>(times_s.size()), static_cast<Eigen::Index>(N));
  for (std::size_t sample = 0; sample < times_s.size(); ++sample) {
    for (std::size_t i = 0; i < N; ++i)
      result(static_cast<Eigen::Index>(sample), static_cast<Eigen::Index>(i)) = x[i];
    if (sample + 1 == times_s.size()) break;
    const double h = (times_s[sample + 1] - times_s[sample]) / steps;
    for (int step = 0; step < steps; ++step) {
      const double t = times_s[sample] + h * step;
      const Point k1 = rates(x, t);
      const Point k2 = rates(moved(x, k1, 0.5 * h), t + 0.5 * h);
      const Point k3 = rates(moved(x, k2, 0.5 * h), t + 0.5 * h);
      const Point k4 = rates(moved(x, k3, h), t + h);
      for (std::size_t i = 0; i < N; ++i) x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    }
  }
  return result;
}

/// The root of the model with eps = 100 Pa, which the rigs of the tests have.
inline double rounded_root(double head_pa) {
  return head_pa / std::pow(head_pa * head_pa + 1e4, 0.25);
}

}  // namespace rigcal::model
