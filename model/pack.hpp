#pragma once

#include <array>
#include <cstddef>

namespace rigcal::model {

/// N numbers that are added and multiplied together: the derivatives of a dual number. Not
/// initialised unless asked for, as a double.
template <typename T, int N>
struct Pack {
  std::array<T, static_cast<std::size_t>(N)> part;
  static constexpr std::size_t kParts = N;

  const T& operator[](std::size_t i) const { return part[i]; }
  void set(std::size_t i, const T& x) { part[i] = x; }
};

/// Doubles fill vector registers, as wide as the instruction set that this is compiled for has
/// them; what is left over of the last one is computed along and never read.
template <int N>
struct Pack<double, N> {
#ifdef __AVX__
  static constexpr std::size_t kLanes = 4;
#else
  static constexpr std::size_t kLanes = 2;
#endif
  static constexpr std::size_t kParts = (N + kLanes - 1) / kLanes;
  using Register __attribute__((vector_size(kLanes * sizeof(double)))) = double;
  std::array<Register, kParts> part;

  double operator[](std::size_t i) const { return part[i / kLanes][i % kLanes]; }
  void set(std::size_t i, double x) { part[i / kLanes][i % kLanes] = x; }
};

template <typename T, int N>
Pack<T, N> operator-(const Pack<T, N>& a) {
  Pack<T, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = -a.part[k];
  return r;
}
template <typename T, int N>
Pack<T, N> operator+(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] + b.part[k];
  return r;
}
template <typename T, int N>
Pack<T, N> operator-(const Pack<T, N>& a, const Pack<T, N>& b) {
  Pack<T, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] - b.part[k];
  return r;
}
/// Every element times a scalar.
template <typename T, int N, typename S>
Pack<T, N> operator*(const Pack<T, N>& a, const S& s) {
  Pack<T, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] * s;
  return r;
}
template <int N>
Pack<double, N> operator*(const Pack<double, N>& a, const Pack<double, N>& b) {
  Pack<double, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] * b.part[k];
  return r;
}
template <int N>
Pack<double, N> operator/(const Pack<double, N>& a, const Pack<double, N>& b) {
  Pack<double, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] / b.part[k];
  return r;
}
template <int N>
Pack<double, N> max(const Pack<double, N>& a, const Pack<double, N>& b) {
  Pack<double, N> r;
  for (std::size_t k = 0; k < r.kParts; ++k)
    r.part[k] = a.part[k] > b.part[k] ? a.part[k] : b.part[k];
  return r;
}
template <int N>
Pack<double, N> abs(const Pack<double, N>& a) {
  return max(a, -a);
}

}  // namespace rigcal::model
