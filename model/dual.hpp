#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace rigcal::model {

/// A value and its derivatives in N directions. Inner type double, or another dual number where
/// second derivatives are wanted (the Jacobian of a Rosenbrock step and its sensitivities).
template <typename T, int N>
struct Dual {
  T value{};
  std::array<T, N> derivative{};

  Dual() = default;
  Dual(const T& v)
      : value(v) {}  // NOLINT(google-explicit-constructor): a constant is a dual number
  template <typename S>
  requires(std::is_arithmetic_v<S> && !std::same_as<S, T>) Dual(S v)
      : value(static_cast<double>(v)) {}  // NOLINT(google-explicit-constructor)

  /// The independent variable of direction `index`.
  static Dual variable(const T& v, int index) {
    Dual result(v);
    result.derivative[static_cast<std::size_t>(index)] = T(1.0);
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
  Dual<T, N> r(f);
  for (std::size_t i = 0; i < N; ++i) r.derivative[i] = slope * x.derivative[i];
  return r;
}

template <typename T, int N>
inline Dual<T, N> operator-(const Dual<T, N>& a) {
  Dual<T, N> r(-a.value);
  for (std::size_t i = 0; i < N; ++i) r.derivative[i] = -a.derivative[i];
  return r;
}

template <typename T, int N>
inline Dual<T, N> operator+(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> r(a.value + b.value);
  for (std::size_t i = 0; i < N; ++i) r.derivative[i] = a.derivative[i] + b.derivative[i];
  return r;
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator+(Dual<T, N> a, const S& b) {
  a.value = a.value + b;
  return a;
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator+(const S& a, const Dual<T, N>& b) {
  return b + a;
}

template <typename T, int N>
inline Dual<T, N> operator-(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> r(a.value - b.value);
  for (std::size_t i = 0; i < N; ++i) r.derivative[i] = a.derivative[i] - b.derivative[i];
  return r;
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator-(Dual<T, N> a, const S& b) {
  a.value = a.value - b;
  return a;
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator-(const S& a, const Dual<T, N>& b) {
  return -b + a;
}

template <typename T, int N>
inline Dual<T, N> operator*(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> r(a.value * b.value);
  for (std::size_t i = 0; i < N; ++i) {
    r.derivative[i] = a.derivative[i] * b.value + a.value * b.derivative[i];
  }
  return r;
}
template <typename T, int N, PassiveFor<T> S>
inline Dual<T, N> operator*(const Dual<T, N>& a, const S& b) {
  Dual<T, N> r(a.value * b);
  for (std::size_t i = 0; i < N; ++i) r.derivative[i] = a.derivative[i] * b;
  return r;
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
template <typename T, int N>
inline Dual<T, N> exp(const Dual<T, N>& a) {
  using std::exp;
  const T f = exp(a.value);
  return chain(a, f, f);
}
template <typename T, int N>
inline Dual<T, N> tanh(const Dual<T, N>& a) {
  using std::tanh;
  const T f = tanh(a.value);
  return chain(a, f, T(1.0 - f * f));
}

}  // namespace rigcal::model
