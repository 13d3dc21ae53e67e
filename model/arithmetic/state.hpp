#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "model/arithmetic/dual.hpp"

namespace rigcal::model {

/// A number with its derivatives with respect to P parameters; a plain double if P is 0.
template <int P>
using Active = std::conditional_t<P == 0, double, Dual<P>>;

/// N state variables, each with its sensitivities to P parameters.
template <int N, int P>
using State = std::array<Active<P>, static_cast<std::size_t>(N)>;

/// The values of N states without their sensitivities.
template <int N>
using Values = std::array<double, static_cast<std::size_t>(N)>;
/// The sensitivities of N states to P parameters.
template <int N, int P>
using Tangents = std::array<Pack<P>, static_cast<std::size_t>(N)>;

template <int P, std::size_t N>
std::array<double, N> values_of(const std::array<Dual<P>, N>& x) {
  std::array<double, N> values;
  for (std::size_t i = 0; i < N; ++i) values[i] = x[i].value;
  return values;
}
template <std::size_t N>
const std::array<double, N>& values_of(const std::array<double, N>& x) {
  return x;
}

/// f and its partial derivatives at one point.
template <int N, int P>
struct Linearisation {
  Values<N> f;
  Values<N> f_t;  ///< derivatives with respect to time
  std::array<Values<N>, static_cast<std::size_t>(N)> jacobian;  ///< [i][k] = d f_i / d x_k
  Tangents<N, P> f_p;  ///< derivatives with respect to each parameter
};

/// y += a x.
template <typename C, std::size_t N>
void add_scaled(std::array<C, N>& y, double a, const std::array<C, N>& x) {
  for (std::size_t i = 0; i < N; ++i) y[i] = y[i] + x[i] * a;
}

}  // namespace rigcal::model
