#pragma once

#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "model/arithmetic/state.hpp"
#include "model/solver/interpolant.hpp"

namespace rigcal::model {

/// Odeint's Dormand-Prince 5(4), an explicit method for rigs that are not stiff.
template <int N, int P>
class DormandPrince {
 public:
  using X = State<N, P>;

  /// @param f_old  derivative at (x, t)
  template <typename System>
  void do_step(const System& system, const X& f_old, const X& x, double t, X& x_out, double dt,
               X& x_err) {
    const auto f = [&system](const X& y, X& dydt, double s) { dydt = system.derivative(y, s); };
    f_old_ = f_old;
    stepper_.do_step(f, x, f_old_, t, x_out, f_new_, dt, x_err);
  }

  /// The solution within the last step: the quartic that has the values and slopes at both ends and
  /// agrees with Odeint's dense output at half time.
  Interpolant<N, P> dense_output(const X& x_old, const X& x_new, double dt) const {
    X middle;
    stepper_.calc_state(0.5 * dt, middle, x_old, f_old_, 0.0, x_new, f_new_, dt);
    Interpolant<N, P> result;
    for (std::size_t i = 0; i < N; ++i) {
      const auto d = x_new[i] - x_old[i];
      const auto m = (middle[i] - x_old[i]) * 16.0;
      const auto f0 = f_old_[i] * dt;
      const auto f1 = f_new_[i] * dt;
      result.coefficient[i] = {x_old[i], f0, m - d * 5.0 - f0 * 4.0 + f1,
                               d * 14.0 - m * 2.0 + f0 * 5.0 - f1 * 3.0,
                               m - d * 8.0 - f0 * 2.0 + f1 * 2.0};
    }
    return result;
  }

  /// Derivative at the end of the last step.
  const X& f_new() const { return f_new_; }

 private:
  boost::numeric::odeint::runge_kutta_dopri5<X, double, X, double,
                                             boost::numeric::odeint::array_algebra>
      stepper_;
  X f_old_{};
  X f_new_{};
};

}  // namespace rigcal::model
