#pragma once

#include <Eigen/LU>
#include <cmath>

namespace rigcal::model {

/// Inverts a small matrix. If the matrix is singular, the elements of the result are not finite.
/// For more than four rows, Eigen would call its routines for large matrices; Gauss-Jordan
/// elimination with row pivoting takes at most half as long.
template <int N>
Eigen::Matrix<double, N, N> inverse_of(const Eigen::Matrix<double, N, N>& matrix) {
  if constexpr (N <= 4) {
    return matrix.inverse();
  } else {
    double row[N][2 * N];  // the matrix, and next to it the inverse under construction
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < N; ++k) {
        row[i][k] = matrix(i, k);
        row[i][N + k] = i == k ? 1.0 : 0.0;
      }
    }
    for (int k = 0; k < N; ++k) {
      int pivot = k;
      for (int i = k + 1; i < N; ++i) {
        if (std::abs(row[i][k]) > std::abs(row[pivot][k])) pivot = i;
      }
      const double scale = 1.0 / row[pivot][k];
      for (int j = 0; j < 2 * N; ++j) {
        const double moved = row[pivot][j] * scale;
        row[pivot][j] = row[k][j];
        row[k][j] = moved;
      }
      for (int i = 0; i < N; ++i) {
        if (i == k) continue;
        const double factor = row[i][k];
        for (int j = 0; j < 2 * N; ++j) row[i][j] -= factor * row[k][j];
      }
    }
    Eigen::Matrix<double, N, N> result;
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < N; ++k) result(i, k) = row[i][N + k];
    }
    return result;
  }
}

}  // namespace rigcal::model
