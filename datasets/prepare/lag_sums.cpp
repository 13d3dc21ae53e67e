#include "datasets/prepare/lag_sums.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

// The sums are compiled twice: for any x86-64, and for AVX2. Neither version uses FMA, so that both
// round alike.
#if defined(__x86_64__) && !defined(__AVX2__)
#define RIGCAL_SUMS_IN_TWO_WIDTHS
#endif

namespace rigcal::datasets {
namespace {

constexpr std::size_t kLanes = 4;
// Number of sums computed together. An addition takes four cycles, and two can start in each cycle:
// with only four sums the processor would wait for their results.
constexpr std::size_t kTogether = 8;
#define RIGCAL_UNROLLED _Pragma("GCC unroll 8")  // keeps the sums in registers

using Lanes __attribute__((vector_size(kLanes * sizeof(double)))) = double;

// Functions with vector arguments must be inlined: the two instruction sets pass them differently.
#define RIGCAL_INLINED [[gnu::always_inline]] inline

RIGCAL_INLINED void add_product(Lanes& sum, const Lanes& factor, const double* x) {
  Lanes other;
  std::memcpy(&other, x, sizeof other);
  sum += factor * other;
}

/// Completes a shifted product of `n` terms. The lanes already contain the first `done` terms.
RIGCAL_INLINED double finished(Lanes& lanes, const double* fixed, const double* moving,
                               std::size_t done, std::size_t n) {
  for (; done + kLanes <= n; done += kLanes) {
    Lanes factor;
    std::memcpy(&factor, fixed + done, sizeof factor);
    add_product(lanes, factor, moving + done);
  }
  double even = lanes[0] + lanes[2];
  double odd = lanes[1] + lanes[3];
  if (done + 2 <= n) {
    even += fixed[done] * moving[done];
    odd += fixed[done + 1] * moving[done + 1];
    done += 2;
  }
  double sum = even + odd;
  if (done < n) sum += fixed[done] * moving[done];
  return sum;
}

/// Products for kTogether consecutive shifts.
/// @param n  number of terms for each shift: each has as many as the one before, or one fewer
RIGCAL_INLINED void products_in(const double* fixed, const double* moving,
                                const std::array<std::size_t, kTogether>& n, double* result) {
  std::array<Lanes, kTogether> sums{};
  const std::size_t common = n.back() - n.back() % kLanes;
  for (std::size_t i = 0; i < common; i += kLanes) {
    Lanes factor;
    std::memcpy(&factor, fixed + i, sizeof factor);
    RIGCAL_UNROLLED
    for (std::size_t k = 0; k < kTogether; ++k) add_product(sums[k], factor, moving + i + k);
  }
  RIGCAL_UNROLLED
  for (std::size_t k = 0; k < kTogether; ++k)
    result[k] = finished(sums[k], fixed, moving + k, common, n[k]);
}

/// Computes kTogether * kLanes consecutive weighted sums.
RIGCAL_INLINED void weighted_in(const double* x, const double* kernel, std::size_t taps,
                                double* result) {
  std::array<Lanes, kTogether> sums{};
  for (std::size_t j = 0; j < taps; ++j) {
    const Lanes factor = Lanes{} + kernel[j];
    RIGCAL_UNROLLED
    for (std::size_t k = 0; k < kTogether; ++k) add_product(sums[k], factor, x + j + k * kLanes);
  }
  std::memcpy(result, sums.data(), sizeof sums);
}

/// The two sums, compiled for one instruction set.
struct Sums {
  void (*products)(const double* fixed, const double* moving,
                   const std::array<std::size_t, kTogether>& n, double* result);
  void (*weighted)(const double* x, const double* kernel, std::size_t taps, double* result);
};

constexpr Sums kSums{
    [](const double* fixed, const double* moving, const std::array<std::size_t, kTogether>& n,
       double* result) { products_in(fixed, moving, n, result); },
    [](const double* x, const double* kernel, std::size_t taps, double* result) {
      weighted_in(x, kernel, taps, result);
    }};

#ifdef RIGCAL_SUMS_IN_TWO_WIDTHS
[[gnu::target("avx2")]] void wide_products(const double* fixed, const double* moving,
                                           const std::array<std::size_t, kTogether>& n,
                                           double* result) {
  products_in(fixed, moving, n, result);
}
[[gnu::target("avx2")]] void wide_weighted(const double* x, const double* kernel, std::size_t taps,
                                           double* result) {
  weighted_in(x, kernel, taps, result);
}

Sums fastest() {
  return __builtin_cpu_supports("avx2") ? Sums{wide_products, wide_weighted} : kSums;
}
#else
Sums fastest() { return kSums; }
#endif

const Sums& sums() {
  static const Sums chosen = fastest();
  return chosen;
}

}  // namespace

std::vector<double> shifted_products(std::span<const double> fixed, std::span<const double> moving,
                                     int first, int last) {
  std::vector<double> result;
  const auto terms = [&](std::size_t shift) {
    return shift < moving.size() ? std::min(fixed.size(), moving.size() - shift) : 0;
  };
  const auto end = static_cast<std::size_t>(last) + 1;
  for (auto shift = static_cast<std::size_t>(first); shift < end; shift += kTogether) {
    const std::size_t wanted = std::min(kTogether, end - shift);
    if (shift + kTogether > moving.size()) {
      for (std::size_t k = 0; k < wanted; ++k) {
        Lanes none{};
        result.push_back(
            finished(none, fixed.data(), moving.data() + shift + k, 0, terms(shift + k)));
      }
      continue;
    }
    std::array<double, kTogether> block{};
    std::array<std::size_t, kTogether> n{};
    for (std::size_t k = 0; k < kTogether; ++k) n[k] = terms(shift + k);
    sums().products(fixed.data(), moving.data() + shift, n, block.data());
    result.insert(result.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(wanted));
  }
  return result;
}

std::vector<double> weighted_sums(std::span<const double> x, std::span<const double> kernel) {
  if (kernel.empty() || x.size() < kernel.size()) return {};
  constexpr std::size_t kBlock = kTogether * kLanes;
  std::vector<double> result(x.size() - kernel.size() + 1);
  std::size_t i = 0;
  for (; i + kBlock <= result.size(); i += kBlock)
    sums().weighted(x.data() + i, kernel.data(), kernel.size(), result.data() + i);
  for (; i < result.size(); ++i)
    for (std::size_t j = 0; j < kernel.size(); ++j) result[i] += kernel[j] * x[i + j];
  return result;
}

}  // namespace rigcal::datasets
