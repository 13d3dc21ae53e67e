#include "calib/problem/scaled_svd.hpp"

template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace rigcal::calib {

ScaledSvd::ScaledSvd(const Eigen::MatrixXd& jacobian, double threshold)
    : inverse_lengths_(jacobian.colwise().norm().transpose().unaryExpr(
          [](double length) { return length > 0.0 ? 1.0 / length : 0.0; })),
      svd_(jacobian * inverse_lengths_.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeFullV) {
  svd_.setThreshold(threshold);
  rank_ = svd_.rank();
}

Eigen::MatrixXd ScaledSvd::root() const {
  return inverse_lengths_.asDiagonal() * V().leftCols(rank_) *
         singular_values().head(rank_).cwiseInverse().asDiagonal();
}

}  // namespace rigcal::calib
