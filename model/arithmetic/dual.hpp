#pragma once

#include <cmath>

#include "model/arithmetic/pack.hpp"

namespace rigcal::model {

/// A value and its derivatives in N directions: with respect to the parameters, or to the states
/// and time. docs/decisions/0001 explains why this is not ceres::Jet.
template <int N>
struct Dual {
  double value;
  Pack<N> derivative;

  Dual() = default;
  Dual(double v) : value(v), derivative{} {}  // NOLINT(google-explicit-constructor): a constant
  Dual(double v, const Pack<N>& d) : value(v), derivative(d) {}
  // Copies value and derivative separately. The default copy reads both at once, and has to wait
  // for a value that was just written (docs/decisions/0004).
  Dual(const Dual& b) : value(b.value), derivative(b.derivative) {}
  Dual& operator=(const Dual& b) {
    value = b.value;
    derivative = b.derivative;
    return *this;
  }

  /// Returns an independent variable, whose derivative is one in direction `index`.
  static Dual variable(double v, int index) {
    return {v, Pack<N>::unit(static_cast<std::size_t>(index))};
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
};

inline double value_of(double x) { return x; }
template <int N>
double value_of(const Dual<N>& x) {
  return x.value;
}

/// Applies the chain rule: f(x), given f and f' at the value of x.
template <int N>
inline Dual<N> chain(const Dual<N>& x, double f, double slope) {
  return {f, x.derivative * slope};
}

template <int N>
inline Dual<N> operator-(const Dual<N>& a) {
  return {-a.value, -a.derivative};
}

template <int N>
inline Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
  return {a.value + b.value, a.derivative + b.derivative};
}
template <int N>
inline Dual<N> operator+(const Dual<N>& a, double b) {
  return {a.value + b, a.derivative};
}
template <int N>
inline Dual<N> operator+(double a, const Dual<N>& b) {
  return {a + b.value, b.derivative};
}

template <int N>
inline Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
  return {a.value - b.value, a.derivative - b.derivative};
}
template <int N>
inline Dual<N> operator-(const Dual<N>& a, double b) {
  return {a.value - b, a.derivative};
}
template <int N>
inline Dual<N> operator-(double a, const Dual<N>& b) {
  return {a - b.value, -b.derivative};
}

template <int N>
inline Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
  return {a.value * b.value, a.derivative * b.value + b.derivative * a.value};
}
template <int N>
inline Dual<N> operator*(const Dual<N>& a, double b) {
  return {a.value * b, a.derivative * b};
}
template <int N>
inline Dual<N> operator*(double a, const Dual<N>& b) {
  return b * a;
}

template <int N>
inline Dual<N> inverse(const Dual<N>& a) {
  const double f = 1.0 / a.value;
  return chain(a, f, -(f * f));
}
template <int N>
inline Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
  return a * inverse(b);
}
template <int N>
inline Dual<N> operator/(const Dual<N>& a, double b) {
  return a * (1.0 / b);
}
template <int N>
inline Dual<N> operator/(double a, const Dual<N>& b) {
  return inverse(b) * a;
}

template <int N>
inline Dual<N> sqrt(const Dual<N>& a) {
  const double f = std::sqrt(a.value);
  return chain(a, f, 0.5 / f);
}
/// x^(-1/4) for x > 0. It costs one division and two roots, whatever the number of derivatives.
inline double inverse_fourth_root(double x) { return 1.0 / std::sqrt(std::sqrt(x)); }
template <int N>
inline Dual<N> inverse_fourth_root(const Dual<N>& a) {
  const double f = inverse_fourth_root(a.value);
  const double f2 = f * f;
  return chain(a, f, -0.25 * (f2 * f2 * f));
}
template <int N>
inline Dual<N> exp(const Dual<N>& a) {
  const double f = std::exp(a.value);
  return chain(a, f, f);
}
template <int N>
inline Dual<N> log(const Dual<N>& a) {
  return chain(a, std::log(a.value), 1.0 / a.value);
}
template <int N>
inline Dual<N> tanh(const Dual<N>& a) {
  const double f = std::tanh(a.value);
  return chain(a, f, 1.0 - f * f);
}
template <int N>
inline Dual<N> sin(const Dual<N>& a) {
  return chain(a, std::sin(a.value), std::cos(a.value));
}
template <int N>
inline Dual<N> cos(const Dual<N>& a) {
  return chain(a, std::cos(a.value), -std::sin(a.value));
}

}  // namespace rigcal::model
