#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "model/rosenbrock.hpp"

namespace rigcal::model {

/// Error of a step in units of the tolerance. Each state is measured against its own running peak,
/// since velocity and pressure differ by 1e7; each sensitivity against its running peak too, but no
/// finer than a small part of what the parameter's own size would move the state by. Both are in
/// the step control: without the sensitivities they diverge where the states do not (paper.md).
template <int N, int P>
class ErrorNorm {
 public:
  using State = StateMatrix<N, P>;

  /// @param floor            shape (N): below it a state counts as zero
  /// @param parameter_scale  shape (P): typical size of each parameter, > 0
  ErrorNorm(const Eigen::Matrix<double, N, 1>& floor,
            const std::array<double, static_cast<std::size_t>(P)>& parameter_scale,
            double tolerance)
      : parameter_scale_(parameter_scale), tolerance_(tolerance) {
    peak_.setZero();
    peak_.col(0) = floor;
  }

  void see(const State& x) { peak_ = peak_.cwiseMax(x.cwiseAbs()); }

  /// Root mean square over the states, largest over state and sensitivities; not finite if the
  /// error is not.
  double operator()(const State& error, const State& x_new) const {
    double worst = 0.0;
    for (int j = 0; j <= P; ++j) {
      double sum = 0.0;
      for (int i = 0; i < N; ++i) {
        double scale = std::max(peak_(i, j), std::abs(x_new(i, j)));
        double tolerance = tolerance_;
        if (j > 0) {
          const double state_scale = std::max(peak_(i, 0), std::abs(x_new(i, 0)));
          scale = std::max(scale, kSensitivityFloor * state_scale /
                                      parameter_scale_[static_cast<std::size_t>(j - 1)]);
          tolerance *= kSensitivityLooseness;
        }
        const double e = error(i, j) / (tolerance * scale);
        sum += e * e;
      }
      const double norm = std::sqrt(sum / N);
      if (!std::isfinite(norm)) return norm;
      worst = std::max(worst, norm);
    }
    return worst;
  }

 private:
  static constexpr double kSensitivityFloor = 1e-2;
  static constexpr double kSensitivityLooseness = 10.0;
  State peak_;
  std::array<double, static_cast<std::size_t>(P)> parameter_scale_;
  double tolerance_;
};

}  // namespace rigcal::model
