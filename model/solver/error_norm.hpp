#pragma once

#include <algorithm>
#include <cmath>

#include "model/arithmetic/state.hpp"

namespace rigcal::model {

/// Error of a step in units of the tolerance. Each state is compared with its own running peak,
/// because the scales of velocity and pressure differ by 1e7. Each sensitivity is compared with its
/// running peak, too, but never more strictly than with a small fraction of the parameter's effect
/// on the state. Both control the step; otherwise sensitivities can diverge while the states do not
/// (paper.md). If N exceeds the number of states, the unused ones do not count.
template <int N, int P>
class ErrorNorm {
 public:
  using X = State<N, P>;

  /// @param states           number of states of the rig, at most N; the others must stay zero
  /// @param floor            shape (N): size below which a state counts as zero
  /// @param parameter_scale  shape (P): typical size of each parameter, > 0
  ErrorNorm(int states, const std::array<double, static_cast<std::size_t>(N)>& floor,
            const std::array<double, static_cast<std::size_t>(P)>& parameter_scale,
            double tolerance, double sensitivity_looseness)
      : states_(states),
        tolerance_(tolerance),
        sensitivity_tolerance_(sensitivity_looseness * tolerance) {
    for (std::size_t i = 0; i < N; ++i) peak_[i] = Active<P>(floor[i]);
    if constexpr (P > 0) {
      for (std::size_t j = 0; j < P; ++j)
        sensitivity_floor_.set(j, kSensitivityFloor / parameter_scale[j]);
    }
  }

  void see(const X& x) {
    for (std::size_t i = 0; i < N; ++i) peak_[i] = peak_of(i, x[i]);
  }

  /// Root mean square of the error over the states; not finite if the error is not.
  double of_states(const X& error, const X& x_new) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double peak = std::max(value_of(peak_[i]), std::abs(value_of(x_new[i])));
      const double e = value_of(error[i]) / (tolerance_ * peak);
      sum += e * e;
    }
    return std::sqrt(sum / states_);
  }

  /// Root mean square over the states for each sensitivity column, maximised over the columns; not
  /// finite if an error is not.
  double of_sensitivities(const X& error, const X& x_new) const {
    double worst = 0.0;
    if constexpr (P > 0) {
      Pack<P> sum{};
      for (std::size_t i = 0; i < N; ++i) {
        const Active<P> peak = peak_of(i, x_new[i]);
        const auto scale = max(peak.derivative, sensitivity_floor_ * peak.value);
        const auto e = error[i].derivative / scale;
        sum = sum + e * e;
      }
      for (std::size_t j = 0; j < P && std::isfinite(worst); ++j) {
        const double column = sum[j];
        if (!(column <= worst)) worst = column;  // true for NaN, too
      }
    }
    return std::sqrt(worst / states_) / sensitivity_tolerance_;
  }

  /// Inner product of a and b over the states, each in units of the tolerance.
  Active<P> inner(const X& a, const X& b) const {
    Active<P> sum(0.0);
    for (std::size_t i = 0; i < N; ++i) {
      const double unit = tolerance_ * value_of(peak_[i]);
      sum = sum + a[i] * b[i] * (1.0 / (unit * unit));
    }
    return sum;
  }

 private:
  static constexpr double kSensitivityFloor = 1e-2;

  Active<P> peak_of(std::size_t i, const Active<P>& x) const {
    if constexpr (P == 0) {
      return std::max(peak_[i], std::abs(x));
    } else {
      Active<P> peak(std::max(peak_[i].value, std::abs(x.value)));
      peak.derivative = max(peak_[i].derivative, abs(x.derivative));
      return peak;
    }
  }

  X peak_;
  Pack<P> sensitivity_floor_{};
  double states_;
  double tolerance_;
  double sensitivity_tolerance_;
};

}  // namespace rigcal::model
