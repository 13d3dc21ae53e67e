#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace rigcal::model {

/// N numbers that are added and multiplied together: the derivatives of a dual number. They fill
/// vector registers of the instruction set in use. Surplus elements of the last register are
/// computed but never read. Like a double, a pack is uninitialised by default.
template <int N>
struct Pack {
#ifdef __AVX__
  static constexpr std::size_t kLanes = 4;
#else
  static constexpr std::size_t kLanes = 2;
#endif
  static constexpr std::size_t kParts = (N + kLanes - 1) / kLanes;
  using Register __attribute__((vector_size(kLanes * sizeof(double)))) = double;
  std::array<Register, kParts> part;

  /// Returns a pack with one at `index` and zero elsewhere. It is built in registers, because set()
  /// would write to memory.
  static Pack unit(std::size_t index) {
    Pack r;
    for (std::size_t k = 0; k < kParts; ++k)
      r.part[k] = one_at(index - k * kLanes, std::make_index_sequence<kLanes>{});
    return r;
  }

  double operator[](std::size_t i) const { return part[i / kLanes][i % kLanes]; }
  void set(std::size_t i, double x) { part[i / kLanes][i % kLanes] = x; }

 private:
  template <std::size_t... Lane>
  static Register one_at(std::size_t lane, std::index_sequence<Lane...> /*all*/) {
    return Register{(Lane == lane ? 1.0 : 0.0)...};
  }
};

/// Replaces one block of a pack, whose size is a multiple of the block's.
template <int N, int M>
void put(const Pack<N>& block, std::size_t index, Pack<M>& whole) {
  static_assert(M % N == 0 && N % Pack<N>::kLanes == 0);
  for (std::size_t k = 0; k < block.kParts; ++k)
    whole.part[index * block.kParts + k] = block.part[k];
}

template <int N>
Pack<N> operator-(const Pack<N>& a) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = -a.part[k];
  return r;
}
template <int N>
Pack<N> operator+(const Pack<N>& a, const Pack<N>& b) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] + b.part[k];
  return r;
}
template <int N>
Pack<N> operator-(const Pack<N>& a, const Pack<N>& b) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] - b.part[k];
  return r;
}
template <int N>
Pack<N> operator*(const Pack<N>& a, double s) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] * s;
  return r;
}
template <int N>
Pack<N> operator*(const Pack<N>& a, const Pack<N>& b) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] * b.part[k];
  return r;
}
template <int N>
Pack<N> operator/(const Pack<N>& a, const Pack<N>& b) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k) r.part[k] = a.part[k] / b.part[k];
  return r;
}
template <int N>
Pack<N> max(const Pack<N>& a, const Pack<N>& b) {
  Pack<N> r;
  for (std::size_t k = 0; k < r.kParts; ++k)
    r.part[k] = a.part[k] > b.part[k] ? a.part[k] : b.part[k];
  return r;
}
template <int N>
Pack<N> abs(const Pack<N>& a) {
  return max(a, -a);
}

}  // namespace rigcal::model
