#pragma once

#include <cmath>
#include <concepts>
#include <type_traits>

#include "model/pack.hpp"

namespace rigcal::model {

/// A value and its derivatives in N directions. Inner type double, or another dual number where
/// second derivatives are wanted (the Jacobian of a Rosenbrock step and its sensitivities).
template <typename T, int N>
struct Dual {
  T value;
  Pack<T, N> derivative;

  Dual() = default;
  Dual(const T& v) : value(v), derivative{} {}  // NOLINT(google-explicit-constructor): a constant
  template <typename S>
  requires(std::is_arithmetic_v<S> && !std::same_as<S, T>) Dual(S v)
      : Dual(T(static_cast<double>(v))) {}  // NOLINT(google-explicit-constructor)
  Dual(const T& v, const Pack<T, N>& d) : value(v), derivative(d) {}

  /// The independent variable of direction `index`.
  static Dual variable(const T& v, int index) {
    Dual result(v);
    result.derivative.set(static_cast<std::size_t>(index), T(1.0));
    return result;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
};

/// Scalars that carry no derivative in the directions of Dual<T, N>.
template <typename S, typename T>
concept PassiveFor = std::same_as<S, T> || std::is_arithmetic_v<S>;

inline double value_of(double x) { return x; }
template <typename T, int N>
double value_of(const Dual<T, N>& x) {
  return value_of(x.value);
}

/// f(x) from f and f' at the value.
template <typename T, int N>
inline Dual<T, N> chain(const Dual<T, N>& x, const T& f, const T& slope) {
  return {f, x.derivative * slope};
}

template <typename T, int N>
inline Dual<T, N> operator-(const Dual<T, N>& a) {
  return {-a.value, -a.derivative};
}

template <typename T, int N>
inline Dual<T, N> operator+(const Dual<T, N>& a, const Dual<T, N>& b) {
  return {a.value + b.value, a.derivative + b.derivative};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator+(const Dual<T, N>& a, const S& b) {
  return {a.value + b, a.derivative};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator+(const S& a, const Dual<T, N>& b) {
  return {a + b.value, b.derivative};
}

template <typename T, int N>
inline Dual<T, N> operator-(const Dual<T, N>& a, const Dual<T, N>& b) {
  return {a.value - b.value, a.derivative - b.derivative};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator-(const Dual<T, N>& a, const S& b) {
  return {a.value - b, a.derivative};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator-(const S& a, const Dual<T, N>& b) {
  return {a - b.value, -b.derivative};
}

template <typename T, int N>
inline Dual<T, N> operator*(const Dual<T, N>& a, const Dual<T, N>& b) {
  return {a.value * b.value, a.derivative * b.value + b.derivative * a.value};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator*(const Dual<T, N>& a, const S& b) {
  return {a.value * b, a.derivative * b};
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator*(const S& a, const Dual<T, N>& b) {
  return b * a;
}

template <typename T, int N>
inline Dual<T, N> inverse(const Dual<T, N>& a) {
  const T f = 1.0 / a.value;
  return chain(a, f, T(-(f * f)));
}
template <typename T, int N>
inline Dual<T, N> operator/(const Dual<T, N>& a, const Dual<T, N>& b) {
  return a * inverse(b);
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator/(const Dual<T, N>& a, const S& b) {
  return a * (1.0 / b);
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator/(const S& a, const Dual<T, N>& b) {
  return inverse(b) * a;
}

template <typename T, int N>
inline Dual<T, N> sqrt(const Dual<T, N>& a) {
  using std::sqrt;
  const T f = sqrt(a.value);
  return chain(a, f, T(0.5 / f));
}
/// x^(-1/4), x > 0: one division and two roots, whatever the number of derivatives.
inline double inverse_fourth_root(double x) { return 1.0 / std::sqrt(std::sqrt(x)); }
template <typename T, int N>
inline Dual<T, N> inverse_fourth_root(const Dual<T, N>& a) {
  const T f = inverse_fourth_root(a.value);
  const T f2 = f * f;
  return chain(a, f, T(-0.25 * (f2 * f2 * f)));
}
template <typename T, int N>
inline Dual<T, N> exp(const Dual<T, N>& a) {
  using std::exp;
  const T f = exp(a.value);
  return chain(a, f, f);
}
template <typename T, int N>
inline Dual<T, N> log(const Dual<T, N>& a) {
  using std::log;
  return chain(a, T(log(a.value)), T(1.0 / a.value));
}
template <typename T, int N>
inline Dual<T, N> tanh(const Dual<T, N>& a) {
  using std::tanh;
  const T f = tanh(a.value);
  return chain(a, f, T(1.0 - f * f));
}

}  // namespace rigcal::model
