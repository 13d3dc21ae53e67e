#pragma once

#include <cmath>

#include "model/arithmetic/dual.hpp"

// Every function of the model with a kink or a singularity lives here, with its derivative in mind:
// a bare sqrt at zero pressure has an infinite slope and stops any gradient.

namespace rigcal::model {

/// Signed root of a pressure, straightened below `smoothing_pa`: P / (P^2 + eps^2)^(1/4), which is
/// sgn(P) sqrt(|P|) far from zero and P / sqrt(eps) at it.
///
/// @param pressure_pa   any sign [Pa]
/// @param smoothing_pa  eps > 0 [Pa]; at eps = 100 Pa the leak shares of the paper move < 0.1 point
/// @return              [Pa^(1/2)]
template <typename X, typename C>
X signed_sqrt(const X& pressure_pa, const C& smoothing_pa) {
  return pressure_pa * inverse_fourth_root(pressure_pa * pressure_pa + smoothing_pa * smoothing_pa);
}

/// Sign of a velocity, straightened below `smoothing`: tanh(v / v_0).
template <typename X, typename C>
X smooth_sign(const X& v, const C& smoothing) {
  using std::tanh;
  return tanh(v / smoothing);
}

/// x within [-limit, limit]; continuous, its slope jumps at the limit.
template <typename X, typename C>
X clamp_symmetric(const X& x, const C& limit) {
  if (value_of(x) > value_of(limit)) return X(limit);
  if (value_of(x) < -value_of(limit)) return X(-limit);
  return x;
}

/// x with the band [-width, width] cut out: opening of an overlapped spool.
template <typename X, typename C>
X dead_band(const X& x, const C& width) {
  if (value_of(x) > value_of(width)) return x - width;
  if (value_of(x) < -value_of(width)) return x + width;
  return x * 0.0;
}

/// x if positive, else zero: travel of a contact or an opened edge.
template <typename X>
X positive_part(const X& x) {
  return value_of(x) > 0.0 ? x : X(x * 0.0);
}

/// x, but `least` where x falls below it.
template <typename X>
X at_least(const X& x, double least) {
  return value_of(x) > least ? x : X(x * 0.0 + least);
}

}  // namespace rigcal::model
