#pragma once

#include <Eigen/Core>

namespace rigcal::calib {

/// Replaces the many rows of [J r] by an upper triangle R with R^T R = [J r]^T [J r]. Cost,
/// gradient and Gauss-Newton matrix of least squares stay the same up to rounding, and the
/// condition number is not squared. Rows are added in blocks, in the given order.
class RFactor {
 public:
  explicit RFactor(Eigen::Index columns) : factor_(Eigen::MatrixXd::Zero(columns, columns)) {}

  /// @param rows  shape (any, columns)
  void add(Eigen::MatrixXd rows);

  const Eigen::MatrixXd& get() const { return factor_; }

  static constexpr Eigen::Index kBlock = 512;  ///< rows taken together: they stay in the cache

 private:
  Eigen::MatrixXd factor_;
};

}  // namespace rigcal::calib
