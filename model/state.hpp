#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "model/dual.hpp"

namespace rigcal::model {

/// A number with the derivatives by P parameters; a plain double for none.
template <int P>
using Active = std::conditional_t<P == 0, double, Dual<double, P>>;

/// N state variables, each with its sensitivities to P parameters.
template <int N, int P>
using State = std::array<Active<P>, static_cast<std::size_t>(N)>;

/// f, its Jacobian and time derivative at one point, with the derivatives of all of them by each
/// parameter.
template <int N, int P>
struct Linearisation {
  State<N, P> f;
  State<N, P> f_t;
  std::array<State<N, P>, static_cast<std::size_t>(N)> jacobian;  ///< [i][k] = d f_i / d x_k
};

/// y += a x.
template <typename C, std::size_t N>
void add_scaled(std::array<C, N>& y, double a, const std::array<C, N>& x) {
  for (std::size_t i = 0; i < N; ++i) y[i] += x[i] * a;
}

}  // namespace rigcal::model
