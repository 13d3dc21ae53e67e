#pragma once

#include <Eigen/Core>

namespace rigcal::calib {

/// Replaces the many rows of [J r] by an upper triangle R with R^T R = [J r]^T [J r]. This
/// preserves cost, gradient and Gauss-Newton matrix up to rounding, and does not square the
/// condition number. Rows are added in blocks, in the given order.
class RFactor {
 public:
  explicit RFactor(Eigen::Index columns) : factor_(Eigen::MatrixXd::Zero(columns, columns)) {}

  /// @param rows  shape (any, columns)
  void add(Eigen::MatrixXd rows);

  const Eigen::MatrixXd& get() const { return factor_; }

  static constexpr Eigen::Index kBlock =
      512;  ///< number of rows per block, small enough for the cache

 private:
  Eigen::MatrixXd factor_;
};

}  // namespace rigcal::calib
