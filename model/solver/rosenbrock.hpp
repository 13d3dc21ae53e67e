#pragma once

#include <array>

#include "model/arithmetic/inverse.hpp"
#include "model/arithmetic/state.hpp"
#include "model/solver/interpolant.hpp"

namespace rigcal::model {

/// Coefficients of RODAS4P, an L-stable, stiffly accurate Rosenbrock method of order 4(3) with
/// dense output, without order reduction on stiff linear problems (G. Steinebach, Order-reduction
/// of ROW-methods for DAEs and method of lines applications, TH Darmstadt preprint 1741, 1995). The
/// form is that of Hairer and Wanner, Solving ODEs II, IV.7.
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

  /// Points of a step at which the Jacobian of the sensitivities is evaluated: start, middle and
  /// end. A parabola interpolates between them.
  static constexpr std::size_t kNodes = 3;
  /// Weight of each node at relative time c within the step.
  static constexpr std::array<double, kNodes> weights(double c) {
    return {(2.0 * c - 1.0) * (c - 1.0), 4.0 * c * (1.0 - c), c * (2.0 * c - 1.0)};
  }
  /// Weight of each node in the slope at the start of the step, times the step size.
  static constexpr std::array<double, kNodes> kFirstSlope{-3.0, 4.0, -1.0};
};

/// RODAS4P as an error stepper with dense output.
///
/// Odeint's own rosenbrock4 (RODAS) has a wrong sign in its d4, which lowers its order for systems
/// that depend on time. It works on heap-allocated uBLAS matrices, has no sensitivities, and needs
/// three times as many steps at a tolerance of 1e-6 with a stiff valve (docs/decisions/0002).
///
/// The sensitivities S follow the states: the method integrates their own equations
///   S' = J(t) S + f_p(t)
/// with the same matrix. J and f_p are evaluated along the dense output of the states, so that no
/// second derivatives are needed (docs/decisions/0009).
template <int N, int P>
class Rosenbrock {
 public:
  using X = State<N, P>;
  using K = Rodas4P;

  /// Advances the states from x at t by dt and leaves their sensitivities unchanged.
  /// @param system  provides derivative_of_values(x, t)
  /// @param lin     linearisation of the system at (x, t)
  template <typename System>
  void do_step(const System& system, const Linearisation<N, P>& lin, const X& x, double t, X& x_out,
               double dt, X& x_err) {
    if constexpr (P == 0 && N <= kMostInlinedStates) {
      do_step_inlined(system, lin, x, t, x_out, dt, x_err);
    } else {
      do_step_by_calls(system, lin, x, t, x_out, dt, x_err);
    }
  }

  /// Advances the sensitivities over the step that do_step() just made.
  /// @param system  provides linearise(x, t)
  /// @return        linearisation at the end of the step
  template <typename System>
  const Linearisation<N, P>& sensitivities(const System& system, const Linearisation<N, P>& lin,
                                           const X& x, double t, X& x_out, double dt,
                                           X& x_err) requires(P > 0) {
    const Interpolant<N, 0> states = dense_values();
    Values<N> middle;
    for (std::size_t i = 0; i < N; ++i) middle[i] = states(i, 0.5);
    nodes_[0] = lin;
    nodes_[1] = system.linearise(middle, t + 0.5 * dt);
    nodes_[2] = system.linearise(x_new_, t + dt);
    for (std::size_t i = 0; i < N; ++i) start_[i] = x[i].derivative;
    // dt (J' S + f_p'), with the time derivatives computed from the values at the nodes.
    change_ = Tangents<N, P>{};
    for (std::size_t k = 0; k < K::kNodes; ++k)
      add_scaled(change_, K::kFirstSlope[k], rate(nodes_[k], start_));
    tangent_stage<0>(dt);
    tangent_stage<1>(dt);
    tangent_stage<2>(dt);
    tangent_stage<3>(dt);
    tangent_stage<4>(dt);
    const Tangents<N, P> point = tangent_stage<5>(dt);
    for (std::size_t i = 0; i < N; ++i) {
      x_err[i].derivative = u_.back()[i];
      x_out[i].derivative = point[i] + u_.back()[i];
    }
    return nodes_.back();
  }

  /// The solution within the last step, as a polynomial.
  Interpolant<N, P> dense_output(const X& x_old, const X& x_new) const {
    const Interpolant<N, 0> states = dense_values();
    if constexpr (P == 0) {
      return states;
    } else {
      Interpolant<N, P> result;
      for (std::size_t i = 0; i < N; ++i) {
        const auto c = dense_coefficients(x_old[i].derivative, x_new[i].derivative, u_, i);
        for (std::size_t k = 0; k < c.size(); ++k)
          result.coefficient[i][k] = {states.coefficient[i][k], c[k]};
        result.coefficient[i][4] = 0.0;
      }
      return result;
    }
  }

 private:
  /// A step calls the right-hand side five times. With three states and no sensitivities, the calls
  /// cost 6 to 7 % of the time. With more states, the inlined step would take too long to compile.
  static constexpr int kMostInlinedStates = 3;

  template <typename System>
  void do_step_by_calls(const System& system, const Linearisation<N, P>& lin, const X& x, double t,
                        X& x_out, double dt, X& x_err) {
    x_old_ = values_of(x);
    factorise(lin, dt);
    stage<0>(system, lin, t, dt);
    stage<1>(system, lin, t, dt);
    stage<2>(system, lin, t, dt);
    stage<3>(system, lin, t, dt);
    stage<4>(system, lin, t, dt);
    stage<5>(system, lin, t, dt);
    x_new_ = point_;
    add_scaled(x_new_, 1.0, g_[K::kStages - 1]);
    for (std::size_t i = 0; i < N; ++i) {
      set_value(x_out[i], x_new_[i]);
      set_value(x_err[i], g_[K::kStages - 1][i]);
    }
  }

  template <typename System>
  [[gnu::flatten]] void do_step_inlined(const System& system, const Linearisation<N, P>& lin,
                                        const X& x, double t, X& x_out, double dt, X& x_err) {
    do_step_by_calls(system, lin, x, t, x_out, dt, x_err);
  }

  static void set_value(double& x, double value) { x = value; }
  static void set_value(Dual<P>& x, double value) { x.value = value; }

  template <int kStage, typename System>
  void stage(const System& system, const Linearisation<N, P>& lin, double t, double dt) {
    Values<N> rhs;
    if constexpr (kStage == 0) {
      rhs = lin.f;
    } else {
      point_ = x_old_;
      for (int j = 0; j < kStage; ++j) add_scaled(point_, K::kState[kStage][j], g_[j]);
      rhs = system.derivative_of_values(point_, t + K::kTime[kStage] * dt);
      for (int j = 0; j < kStage; ++j) add_scaled(rhs, K::kRate[kStage][j] * (1.0 / dt), g_[j]);
    }
    if constexpr (K::kSlope[kStage] != 0.0) add_scaled(rhs, K::kSlope[kStage] * dt, lin.f_t);
    for (int i = 0; i < N; ++i) {
      double sum = 0.0;
      for (int k = 0; k < N; ++k) sum += inverse_(i, k) * rhs[static_cast<std::size_t>(k)];
      g_[kStage][static_cast<std::size_t>(i)] = sum;
    }
  }

  /// Jacobian and derivatives with respect to the parameters at the time of a stage.
  template <std::size_t kStage>
  Linearisation<N, P> linearisation_at() const {
    constexpr auto kWeight = K::weights(K::kTime[kStage]);
    if constexpr (kWeight[0] == 1.0) {
      return nodes_[0];
    } else if constexpr (kWeight[2] == 1.0) {
      return nodes_[2];
    } else {
      Linearisation<N, P> at;
      for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < N; ++k) {
          at.jacobian[i][k] = nodes_[0].jacobian[i][k] * kWeight[0] +
                              nodes_[1].jacobian[i][k] * kWeight[1] +
                              nodes_[2].jacobian[i][k] * kWeight[2];
        }
        at.f_p[i] = nodes_[0].f_p[i] * kWeight[0] + nodes_[1].f_p[i] * kWeight[1] +
                    nodes_[2].f_p[i] * kWeight[2];
      }
      return at;
    }
  }

  /// @return  the tangents at the start of the stage
  template <std::size_t kStage>
  Tangents<N, P> tangent_stage(double dt) {
    Tangents<N, P> point = start_;
    for (std::size_t j = 0; j < kStage; ++j) add_scaled(point, K::kState[kStage][j], u_[j]);
    Tangents<N, P> rhs = rate(linearisation_at<kStage>(), point);
    for (std::size_t j = 0; j < kStage; ++j)
      add_scaled(rhs, K::kRate[kStage][j] * (1.0 / dt), u_[j]);
    if constexpr (K::kSlope[kStage] != 0.0) add_scaled(rhs, K::kSlope[kStage], change_);
    for (std::size_t i = 0; i < N; ++i) {
      const int row = static_cast<int>(i);
      u_[kStage][i] = rhs[0] * inverse_(row, 0);
      for (int k = 1; k < N; ++k)
        u_[kStage][i] = u_[kStage][i] + rhs[static_cast<std::size_t>(k)] * inverse_(row, k);
    }
    return point;
  }

  void factorise(const Linearisation<N, P>& lin, double dt) {
    Eigen::Matrix<double, N, N> w;
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < N; ++k) w(i, k) = -lin.jacobian[std::size_t(i)][std::size_t(k)];
      w(i, i) += 1.0 / (K::kGamma * dt);
    }
    inverse_ = inverse_of(w);
  }

  /// J S + f_p.
  static Tangents<N, P> rate(const Linearisation<N, P>& lin, const Tangents<N, P>& s) {
    Tangents<N, P> result = lin.f_p;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) result[i] = result[i] + s[k] * lin.jacobian[i][k];
    }
    return result;
  }

  /// x_old (1 - s) + s (x_new + (1 - s) (d_0 + s d_1)) in powers of s, for component i.
  template <typename T, typename Stages>
  static std::array<T, 4> dense_coefficients(const T& x_old, const T& x_new, const Stages& stages,
                                             std::size_t i) {
    std::array<T, 2> d;
    for (std::size_t k = 0; k < 2; ++k) {
      d[k] = stages[0][i] * K::kDense[k][0];
      for (std::size_t j = 1; j + 1 < K::kStages; ++j) d[k] = d[k] + stages[j][i] * K::kDense[k][j];
    }
    return {x_old, x_new - x_old + d[0], d[1] - d[0], -d[1]};
  }

  Interpolant<N, 0> dense_values() const {
    Interpolant<N, 0> result;
    for (std::size_t i = 0; i < N; ++i) {
      const auto c = dense_coefficients(x_old_[i], x_new_[i], g_, i);
      result.coefficient[i] = {c[0], c[1], c[2], c[3], 0.0};
    }
    return result;
  }

  Eigen::Matrix<double, N, N> inverse_;
  Values<N> x_old_;
  Values<N> point_;
  Values<N> x_new_;
  std::array<Values<N>, K::kStages> g_;       ///< stages of the states
  std::array<Tangents<N, P>, K::kStages> u_;  ///< stages of their sensitivities
  std::array<Linearisation<N, P>, K::kNodes> nodes_;
  Tangents<N, P> start_;
  Tangents<N, P> change_;
};

}  // namespace rigcal::model
