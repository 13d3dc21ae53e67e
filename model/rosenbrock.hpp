#pragma once

#include <Eigen/LU>
#include <utility>

#include "model/interpolant.hpp"
#include "model/state.hpp"

namespace rigcal::model {

/// Coefficients of RODAS4P, an L-stable, stiffly accurate Rosenbrock method of order 4(3) with
/// dense output whose order does not fall on stiff linear parts (G. Steinebach, Order-reduction of
/// ROW-methods for DAEs and method of lines applications, TH Darmstadt preprint 1741, 1995), in the
/// form of Hairer and Wanner, Solving ODEs II, IV.7.
struct Rodas4P {
  static constexpr int kStages = 6;
  static constexpr double kGamma = 0.25;
  static constexpr double kTime[] = {0.0, 0.75, 0.21, 0.63, 1.0, 1.0};
  static constexpr double kSlope[] = {0.25, -0.5, -0.023504, -0.0362, 0.0, 0.0};
  static constexpr double kState[kStages][kStages] = {
      {},
      {3.0},
      {1.831036793486759, 0.4955183967433795},
      {2.304376582692669, -0.05249275245743001, -1.176798761832782},
      {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401},
      {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401, 1.0}};
  static constexpr double kRate[kStages][kStages] = {
      {},
      {-12.0},
      {-8.791795173947035, -2.207865586973518},
      {10.81793056857153, 6.780270611428266, 19.53485944642410},
      {34.19095006749676, 15.49671153725963, 54.74760875964130, 14.16005392148534},
      {34.62605830930532, 15.30084976114473, 56.99955578662667, 18.40807009793095,
       -5.714285714285717}};
  static constexpr double kDense[2][kStages] = {
      {25.09876703708589, 11.62013104361867, 28.49148307714626, -5.664021568594133},
      {1.638054557396973, -0.7373619806678748, 8.477918219238990, 15.99253148779520,
       -1.882352941176471}};
};

/// RODAS4P as an error stepper with dense output.
///
/// Odeint's own rosenbrock4 (RODAS) has a wrong sign in its d4, which costs it order on systems
/// that depend on time; it works on heap-allocated uBLAS matrices, knows no sensitivities, and
/// needs three times the steps at a tolerance of 1e-6 where a valve is stiff (docs/decisions/0002).
///
/// The sensitivities are the exact derivatives of the discrete step (the same linear systems, their
/// right-hand sides differentiated), hence also the method applied to the variational equations.
template <int N, int P>
class Rosenbrock {
 public:
  using X = State<N, P>;
  using K = Rodas4P;

  /// One step from x at t of size dt.
  /// @param system  has derivative(x, t) -> State
  /// @param lin     linearisation of the system at (x, t)
  template <typename System>
  void do_step(const System& system, const Linearisation<N, P>& lin, const X& x, double t, X& x_out,
               double dt, X& x_err) {
    factorise(lin, dt);
    stage<0>(system, lin, x, t, dt);
    stage<1>(system, lin, x, t, dt);
    stage<2>(system, lin, x, t, dt);
    stage<3>(system, lin, x, t, dt);
    stage<4>(system, lin, x, t, dt);
    stage<5>(system, lin, x, t, dt);
    x_err = g_[K::kStages - 1];
    x_out = point_;
    add_scaled(x_out, 1.0, x_err);
  }

  /// The solution within the step just done, as a polynomial.
  Interpolant<N, P> dense_output(const X& x_old, const X& x_new) const {
    // x_old (1 - s) + s (x_new + (1 - s) (d_0 + s d_1))
    Interpolant<N, P> result;
    for (std::size_t i = 0; i < N; ++i) {
      Active<P> d[2]{};
      for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t j = 0; j + 1 < K::kStages; ++j) d[k] += g_[j][i] * K::kDense[k][j];
      }
      result.coefficient[i] = {x_old[i], x_new[i] - x_old[i] + d[0], d[1] - d[0], -d[1],
                               Active<P>{}};
    }
    return result;
  }

 private:
  template <int kStage, typename System>
  void stage(const System& system, const Linearisation<N, P>& lin, const X& x, double t,
             double dt) {
    X rhs;
    if constexpr (kStage == 0) {
      rhs = lin.f;
    } else {
      point_ = x;
      for (int j = 0; j < kStage; ++j) add_scaled(point_, K::kState[kStage][j], g_[j]);
      rhs = system.derivative(point_, t + K::kTime[kStage] * dt);
      for (int j = 0; j < kStage; ++j) add_scaled(rhs, K::kRate[kStage][j] / dt, g_[j]);
    }
    if constexpr (K::kSlope[kStage] != 0.0) add_scaled(rhs, K::kSlope[kStage] * dt, lin.f_t);
    g_[kStage] = solve(lin, rhs);
  }

  void factorise(const Linearisation<N, P>& lin, double dt) {
    Eigen::Matrix<double, N, N> w;
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < N; ++k) w(i, k) = -value_of(lin.jacobian[std::size_t(i)][std::size_t(k)]);
      w(i, i) += 1.0 / (K::kGamma * dt);
    }
    inverse_ = w.inverse();
  }

  /// Solves W g = rhs for the state, then W g' = rhs' + J' g for each sensitivity.
  X solve(const Linearisation<N, P>& lin, const X& rhs) const {
    X g;
    std::array<double, static_cast<std::size_t>(N)> value;
    for (int i = 0; i < N; ++i) {
      double sum = 0.0;
      for (int k = 0; k < N; ++k) sum += inverse_(i, k) * value_of(rhs[k]);
      value[i] = sum;
    }
    if constexpr (P == 0) {
      g = value;
    } else {
      std::array<Pack<double, P>, static_cast<std::size_t>(N)> tangent;
      for (int i = 0; i < N; ++i) {
        tangent[i] = rhs[i].derivative;
        for (int k = 0; k < N; ++k)
          tangent[i] = tangent[i] + lin.jacobian[i][k].derivative * value[k];
      }
      for (int i = 0; i < N; ++i) {
        Pack<double, P> sum = tangent[0] * inverse_(i, 0);
        for (int k = 1; k < N; ++k) sum = sum + tangent[k] * inverse_(i, k);
        g[i] = {value[i], sum};
      }
    }
    return g;
  }

  Eigen::Matrix<double, N, N> inverse_;
  X point_;
  X g_[K::kStages];
};

}  // namespace rigcal::model
