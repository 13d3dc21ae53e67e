#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>

namespace rigcal::model {

/// State of N variables and their sensitivities to P parameters: column 0 the state, column 1 + j
/// its derivative by parameter j. A row is a dual number.
template <int N, int P>
using StateMatrix = Eigen::Matrix<double, N, 1 + P, P == 0 ? Eigen::ColMajor : Eigen::RowMajor>;

/// f, its Jacobian and time derivative at one point, with the derivatives of all of them along each
/// sensitivity column.
template <int N, int P>
struct Linearisation {
  StateMatrix<N, P> f;
  StateMatrix<N, P> f_t;
  Eigen::Matrix<double, N, N> jacobian;
  std::array<Eigen::Matrix<double, N, N>, static_cast<std::size_t>(P)> jacobian_tangent;
};

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

/// RODAS4P as an Odeint error stepper with dense output.
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
  using State = StateMatrix<N, P>;
  using K = Rodas4P;
  static constexpr int kOrder = 4;

  /// One step from x at t of size dt.
  /// @param system  has derivative(x, t) -> State
  /// @param lin     linearisation of the system at (x, t)
  template <typename System>
  void do_step(const System& system, const Linearisation<N, P>& lin, const State& x, double t,
               State& x_out, double dt, State& x_err) {
    factorise(lin.jacobian, dt);
    State stage = x;
    for (int i = 0; i < K::kStages; ++i) {
      State rhs;
      if (i == 0) {
        rhs = lin.f;
      } else {
        stage = x;
        for (int j = 0; j < i; ++j) stage += K::kState[i][j] * g_[j];
        rhs = system.derivative(stage, t + K::kTime[i] * dt);
        for (int j = 0; j < i; ++j) rhs += (K::kRate[i][j] / dt) * g_[j];
      }
      if (K::kSlope[i] != 0.0) rhs += (K::kSlope[i] * dt) * lin.f_t;
      g_[i] = solve(lin, rhs);
    }
    x_err = g_[K::kStages - 1];
    x_out = stage + x_err;
  }

  /// Prepares calc_state for the step just done.
  void prepare_dense_output() {
    for (int k = 0; k < 2; ++k) {
      dense_[k].setZero();
      for (int j = 0; j < K::kStages - 1; ++j) dense_[k] += K::kDense[k][j] * g_[j];
    }
  }

  /// State at a time within the step just done.
  void calc_state(double t, State& x, const State& x_old, double t_old, const State& x_new,
                  double t_new) const {
    const double s = (t - t_old) / (t_new - t_old);
    x = x_old * (1.0 - s) + s * (x_new + (1.0 - s) * (dense_[0] + s * dense_[1]));
  }

 private:
  void factorise(const Eigen::Matrix<double, N, N>& jacobian, double dt) {
    Eigen::Matrix<double, N, N> w = -jacobian;
    w.diagonal().array() += 1.0 / (K::kGamma * dt);
    inverse_ = w.inverse();
  }

  /// Solves W g = rhs for the state, then W g' = rhs' + J' g for each sensitivity.
  State solve(const Linearisation<N, P>& lin, const State& rhs) const {
    State g;
    const Eigen::Matrix<double, N, 1> g0 = inverse_ * rhs.col(0);
    g.col(0) = g0;
    if constexpr (P > 0) {
      Eigen::Matrix<double, N, P> tangent;
      for (int j = 0; j < P; ++j) {
        tangent.col(j) = rhs.col(1 + j) + lin.jacobian_tangent[static_cast<std::size_t>(j)] * g0;
      }
      g.template rightCols<P>() = inverse_ * tangent;
    }
    return g;
  }

  Eigen::Matrix<double, N, N> inverse_;
  State g_[K::kStages];
  State dense_[2];
};

}  // namespace rigcal::model
