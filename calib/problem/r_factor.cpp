#include "calib/problem/r_factor.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

/// A sum of squares up to this value counts as zero, because its inverse must be finite.
constexpr double kNothing = 1e-300;

}  // namespace

/// Applies Householder reflections. Each acts on one row of the R factor and on the new rows,
/// because all other elements below the diagonal are already zero.
void RFactor::add(Eigen::MatrixXd rows) {
  for (Eigen::Index first = 0; first < rows.rows(); first += kBlock) {
    auto block = rows.middleRows(first, std::min(kBlock, rows.rows() - first));
    for (Eigen::Index k = 0; k < factor_.cols(); ++k) {
      const auto below = block.col(k);
      const double square = below.squaredNorm();
      if (square < kNothing) continue;
      double& diagonal = factor_(k, k);
      const double reflected = -std::copysign(std::sqrt(diagonal * diagonal + square), diagonal);
      const double above = diagonal - reflected;
      const double scale = 2.0 / (above * above + square);
      diagonal = reflected;
      for (Eigen::Index j = k + 1; j < factor_.cols(); ++j) {
        const double share = scale * (above * factor_(k, j) + below.dot(block.col(j)));
        factor_(k, j) -= share * above;
        block.col(j) -= share * below;
      }
    }
  }
}

}  // namespace rigcal::calib
