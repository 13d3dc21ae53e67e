#pragma once

#include <cmath>

#include "model/arithmetic/dual.hpp"

// Every function of the model with a kink or a singularity is here, so that its derivative stays
// usable. A plain sqrt has an infinite slope at zero pressure, which stops any gradient method.

namespace rigcal::model {

/// Signed root of a pressure, linear near zero: P / (P^2 + eps^2)^(1/4). It approaches
/// sgn(P) sqrt(|P|) for |P| >> eps, and P / sqrt(eps) at zero.
///
/// @param pressure_pa   any sign [Pa]
/// @param smoothing_pa  eps > 0 [Pa]; eps = 100 Pa changes the paper's leak shares by less than 0.1
///                      percentage points
/// @return              [Pa^(1/2)]
template <typename X, typename C>
X signed_sqrt(const X& pressure_pa, const C& smoothing_pa) {
  return pressure_pa * inverse_fourth_root(pressure_pa * pressure_pa + smoothing_pa * smoothing_pa);
}

/// Sign of a velocity, smoothed around zero: tanh(v / v_0), where v_0 is `smoothing`.
template <typename X, typename C>
X smooth_sign(const X& v, const C& smoothing) {
  using std::tanh;
  return tanh(v / smoothing);
}

/// Clamps x to [-limit, limit]. Continuous; the slope jumps at the limits.
template <typename X, typename C>
X clamp_symmetric(const X& x, const C& limit) {
  if (value_of(x) > value_of(limit)) return X(limit);
  if (value_of(x) < -value_of(limit)) return X(-limit);
  return x;
}

/// Removes the band [-width, width] from x, like the overlap of a spool.
template <typename X, typename C>
X dead_band(const X& x, const C& width) {
  if (value_of(x) > value_of(width)) return x - width;
  if (value_of(x) < -value_of(width)) return x + width;
  return x * 0.0;
}

/// Returns x if it is positive, else zero. Used for the travel into a contact and the opening of an
/// edge.
template <typename X>
X positive_part(const X& x) {
  return value_of(x) > 0.0 ? x : X(x * 0.0);
}

/// Returns x, but no less than `least`.
template <typename X>
X at_least(const X& x, double least) {
  return value_of(x) > least ? x : X(x * 0.0 + least);
}

}  // namespace rigcal::model
