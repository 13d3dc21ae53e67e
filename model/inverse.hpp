#pragma once

#include <Eigen/LU>
#include <cmath>

namespace rigcal::model {

/// Inverse of a small matrix. Beyond four rows Eigen's goes through routines that are made for
/// large ones and take five times as long; there it is Gauss and Jordan's elimination with pivots
/// by rows. Not finite where the matrix is singular.
template <int N>
Eigen::Matrix<double, N, N> inverse_of(const Eigen::Matrix<double, N, N>& matrix) {
  if constexpr (N <= 4) {
    return matrix.inverse();
  } else {
    Eigen::Matrix<double, N, N, Eigen::RowMajor> left = matrix;
    Eigen::Matrix<double, N, N, Eigen::RowMajor> right = decltype(right)::Identity();
    for (int k = 0; k < N; ++k) {
      int pivot = k;
      for (int i = k + 1; i < N; ++i) {
        if (std::abs(left(i, k)) > std::abs(left(pivot, k))) pivot = i;
      }
      if (pivot != k) {
        left.row(k).swap(left.row(pivot));
        right.row(k).swap(right.row(pivot));
      }
      const double scale = 1.0 / left(k, k);
      left.row(k) *= scale;
      right.row(k) *= scale;
      for (int i = 0; i < N; ++i) {
        if (i == k) continue;
        const double factor = left(i, k);
        left.row(i) -= factor * left.row(k);
        right.row(i) -= factor * right.row(k);
      }
    }
    return right;
  }
}

}  // namespace rigcal::model
