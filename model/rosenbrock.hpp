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

/// RODAS4, an L-stable, stiffly accurate Rosenbrock method of order 4(3) with dense output of order
/// 3 (Hairer and Wanner, Solving ODEs II, IV.7), as an Odeint error stepper with dense output.
///
/// Odeint's rosenbrock4 has the same coefficients but for the sign of d4, which costs it two orders
/// on systems that depend on time (tests/model/rosenbrock_test.cpp), works on heap-allocated uBLAS
/// matrices and knows no sensitivities.
///
/// The sensitivities are the exact derivatives of the discrete step (the same linear systems, their
/// right-hand sides differentiated), hence also the method applied to the variational equations.
template <int N, int P>
class Rosenbrock {
 public:
  using State = StateMatrix<N, P>;
  static constexpr int kOrder = 4;
  static constexpr int kErrorOrder = 3;

  /// One step from x at t of size dt.
  /// @param system  has derivative(x, t) -> State
  /// @param lin     linearisation of the system at (x, t)
  template <typename System>
  void do_step(const System& system, const Linearisation<N, P>& lin, const State& x, double t,
               State& x_out, double dt, State& x_err) {
    factorise(lin.jacobian, dt);
    const double r = 1.0 / dt;
    g1_ = solve(lin, lin.f + dt * kD1 * lin.f_t);
    g2_ = solve(lin, system.derivative(x + 1.544 * g1_, t + 0.386 * dt) + dt * kD2 * lin.f_t -
                         5.6688 * r * g1_);
    g3_ = solve(
        lin,
        system.derivative(x + 0.9466785280815826 * g1_ + 0.2557011698983284 * g2_, t + 0.21 * dt) +
            dt * kD3 * lin.f_t + r * (-2.430093356833875 * g1_ - 0.2063599157091915 * g2_));
    g4_ = solve(lin, system.derivative(x + 3.314825187068521 * g1_ + 2.896124015972201 * g2_ +
                                           0.9986419139977817 * g3_,
                                       t + 0.63 * dt) +
                         dt * kD4 * lin.f_t +
                         r * (-0.1073529058151375 * g1_ - 9.594562251023355 * g2_ -
                              20.47028614809616 * g3_));
    State x_stage = x + 1.221224509226641 * g1_ + 6.019134481288629 * g2_ +
                    12.53708332932087 * g3_ - 0.6878860361058950 * g4_;
    g5_ = solve(lin, system.derivative(x_stage, t + dt) +
                         r * (7.496443313967647 * g1_ - 10.24680431464352 * g2_ -
                              33.99990352819905 * g3_ + 11.70890893206160 * g4_));
    x_stage += g5_;
    x_err = solve(
        lin, system.derivative(x_stage, t + dt) +
                 r * (8.083246795921522 * g1_ - 7.981132988064893 * g2_ - 31.52159432874371 * g3_ +
                      16.31930543123136 * g4_ - 6.058818238834054 * g5_));
    x_out = x_stage + x_err;
  }

  /// Prepares calc_state for the step just done.
  void prepare_dense_output() {
    cont3_ = 10.12623508344586 * g1_ - 7.487995877610167 * g2_ - 34.80091861555747 * g3_ -
             7.992771707568823 * g4_ + 1.025137723295662 * g5_;
    cont4_ = -0.6762803392801253 * g1_ + 6.087714651680015 * g2_ + 16.43084320892478 * g3_ +
             24.76722511418386 * g4_ - 6.594389125716872 * g5_;
  }

  /// State at a time within the step just done.
  void calc_state(double t, State& x, const State& x_old, double t_old, const State& x_new,
                  double t_new) const {
    const double s = (t - t_old) / (t_new - t_old);
    x = x_old * (1.0 - s) + s * (x_new + (1.0 - s) * (cont3_ + s * cont4_));
  }

 private:
  static constexpr double kGamma = 0.25;
  static constexpr double kD1 = 0.25;
  static constexpr double kD2 = -0.1043;
  static constexpr double kD3 = 0.1035;
  static constexpr double kD4 = -0.0362;

  void factorise(const Eigen::Matrix<double, N, N>& jacobian, double dt) {
    Eigen::Matrix<double, N, N> w = -jacobian;
    w.diagonal().array() += 1.0 / (kGamma * dt);
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
  State g1_, g2_, g3_, g4_, g5_, cont3_, cont4_;
};

}  // namespace rigcal::model
