#pragma once

#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "model/rosenbrock.hpp"

namespace rigcal::model {

/// Odeint's Dormand-Prince 5(4) with the interface of Rosenbrock: explicit, for parts that are not
/// stiff and as a check by another method.
template <int N, int P>
class DormandPrince {
 public:
  using State = StateMatrix<N, P>;
  static constexpr int kOrder = 5;

  template <typename System>
  void do_step(const System& system, const Linearisation<N, P>& lin, const State& x, double t,
               State& x_out, double dt, State& x_err) {
    const auto f = [&system](const Flat& y, Flat& dydt, double s) {
      as_matrix(dydt) = system.derivative(as_matrix(y), s);
    };
    as_matrix(f_old_) = lin.f;
    Flat from;
    Flat to;
    Flat error;
    as_matrix(from) = x;
    stepper_.do_step(f, from, f_old_, t, to, f_new_, dt, error);
    x_out = as_matrix(to);
    x_err = as_matrix(error);
  }

  void prepare_dense_output() {}

  void calc_state(double t, State& x, const State& x_old, double t_old, const State& x_new,
                  double t_new) const {
    Flat old_state;
    Flat new_state;
    Flat between;
    as_matrix(old_state) = x_old;
    as_matrix(new_state) = x_new;
    stepper_.calc_state(t, between, old_state, f_old_, t_old, new_state, f_new_, t_new);
    x = as_matrix(between);
  }

 private:
  // Odeint iterates over its states, which Eigen allows for vectors only.
  using Flat = std::array<double, static_cast<std::size_t>(N*(1 + P))>;
  static Eigen::Map<State> as_matrix(Flat& flat) { return Eigen::Map<State>(flat.data()); }
  static Eigen::Map<const State> as_matrix(const Flat& flat) {
    return Eigen::Map<const State>(flat.data());
  }

  boost::numeric::odeint::runge_kutta_dopri5<Flat, double, Flat, double,
                                             boost::numeric::odeint::array_algebra>
      stepper_;
  Flat f_old_{};
  Flat f_new_{};
};

}  // namespace rigcal::model
