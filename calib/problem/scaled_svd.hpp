#pragma once

#include <Eigen/SVD>

// The decomposition takes longer to compile than most files that use it: scaled_svd.cpp does it for
// all.
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace rigcal::calib {

/// Singular values of a Jacobian J whose columns are scaled to length 1, J = U diag(s) V^T
/// diag(length), so that units do not decide which directions count. A column of zeros stays one.
class ScaledSvd {
 public:
  /// @param jacobian   at least as many rows as columns
  /// @param threshold  size, relative to the largest, below which a singular value counts as zero
  ScaledSvd(const Eigen::MatrixXd& jacobian, double threshold);
  /// Decomposes a part of a Jacobian; columns are scaled by their length in the whole one.
  ///
  /// @param inverse_lengths  0 of a column of zeros
  /// @param threshold        relative to 1 where all singular values are less
  ScaledSvd(const Eigen::MatrixXd& jacobian, Eigen::VectorXd inverse_lengths, double threshold);

  Eigen::Index rank() const { return rank_; }
  const Eigen::VectorXd& singular_values() const { return svd_.singularValues(); }
  /// Directions, in scaled coordinates; from column rank() on those that J does not determine.
  const Eigen::MatrixXd& V() const { return svd_.matrixV(); }
  const Eigen::MatrixXd& U() const { return svd_.matrixU(); }
  /// 1 / length of each column; 0 of a column of zeros.
  const Eigen::VectorXd& inverse_lengths() const { return inverse_lengths_; }

  /// Part of a residual that a step can remove, shape (rank()).
  Eigen::VectorXd explained(const Eigen::VectorXd& residual) const {
    return svd_.matrixU().leftCols(rank_).transpose() * residual;
  }
  /// Shape (columns, rank()): root root^T is the inverse of J^T J on the determined directions.
  Eigen::MatrixXd root() const;
  /// x that makes |J x + residual| least, and has no part in undetermined directions.
  Eigen::VectorXd step(const Eigen::VectorXd& residual) const {
    return -root() * explained(residual);
  }

 private:
  Eigen::VectorXd inverse_lengths_;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd_;
  Eigen::Index rank_;
};

}  // namespace rigcal::calib
