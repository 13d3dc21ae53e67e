#pragma once

#include <algorithm>
#include <cmath>

#include "model/arithmetic/state.hpp"

namespace rigcal::model {

/// Estimate of the largest modulus of the eigenvalues of a Jacobian: ||J^8||^(1/8), which depends
/// little on the units of the states.
template <typename C, std::size_t N>
double spectral_radius(const std::array<std::array<C, N>, N>& jacobian) {
  std::array<std::array<double, N>, N> power;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) power[i][k] = value_of(jacobian[i][k]);
  }
  for (int squaring = 0; squaring < 3; ++squaring) {
    const auto root = power;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) {
        power[i][k] = 0.0;
        for (std::size_t l = 0; l < N; ++l) power[i][k] += root[i][l] * root[l][k];
      }
    }
  }
  double trace = 0.0;
  for (std::size_t i = 0; i < N; ++i) trace += std::abs(power[i][i]);
  return std::pow(trace, 0.125);
}

}  // namespace rigcal::model
