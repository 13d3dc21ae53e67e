#pragma once

#include <Eigen/SVD>

// The decomposition takes longer to compile than most files that use it, so only scaled_svd.cpp
// instantiates it.
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace rigcal::calib {

/// Singular value decomposition of a Jacobian J whose columns are scaled to length 1, so that units
/// do not decide which directions count: J = U diag(s) V^T diag(length). A column of zeros is not
/// scaled.
class ScaledSvd {
 public:
  /// @param jacobian   at least as many rows as columns
  /// @param threshold  size, relative to the largest, below which a singular value counts as zero
  ScaledSvd(const Eigen::MatrixXd& jacobian, double threshold);
  /// Decomposes some rows of a Jacobian. Columns are scaled by their lengths in the whole Jacobian.
  ///
  /// @param inverse_lengths  0 for a column of zeros
  /// @param threshold        relative to 1 if all singular values are smaller
  ScaledSvd(const Eigen::MatrixXd& jacobian, Eigen::VectorXd inverse_lengths, double threshold);

  Eigen::Index rank() const { return rank_; }
  const Eigen::VectorXd& singular_values() const { return svd_.singularValues(); }
  /// Directions in scaled coordinates. J does not determine the directions from column rank()
  /// onwards.
  const Eigen::MatrixXd& V() const { return svd_.matrixV(); }
  const Eigen::MatrixXd& U() const { return svd_.matrixU(); }
  /// 1 / length of each column, or 0 for a column of zeros.
  const Eigen::VectorXd& inverse_lengths() const { return inverse_lengths_; }

  /// Component of a residual that a step can remove, shape (rank()).
  Eigen::VectorXd explained(const Eigen::VectorXd& residual) const {
    return svd_.matrixU().leftCols(rank_).transpose() * residual;
  }
  /// R such that R R^T is the inverse of J^T J on the determined directions. Shape (columns,
  /// rank()).
  Eigen::MatrixXd root() const;
  /// x that minimises |J x + residual| and has no component in undetermined directions.
  Eigen::VectorXd step(const Eigen::VectorXd& residual) const {
    return -root() * explained(residual);
  }

 private:
  Eigen::VectorXd inverse_lengths_;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd_;
  Eigen::Index rank_;
};

}  // namespace rigcal::calib
