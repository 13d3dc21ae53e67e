#include "calib/problem/scaled_svd.hpp"

#include <utility>

template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace rigcal::calib {

ScaledSvd::ScaledSvd(const Eigen::MatrixXd& jacobian, double threshold)
    : ScaledSvd(jacobian, jacobian.colwise().norm().transpose().unaryExpr([](double length) {
        return length > 0.0 ? 1.0 / length : 0.0;
      }),
                threshold) {}

ScaledSvd::ScaledSvd(const Eigen::MatrixXd& jacobian, Eigen::VectorXd inverse_lengths,
                     double threshold)
    : inverse_lengths_(std::move(inverse_lengths)),
      svd_(jacobian * inverse_lengths_.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeFullV) {
  const double largest = svd_.singularValues()(0);
  svd_.setThreshold(largest > 0.0 && largest < 1.0 ? threshold / largest : threshold);
  rank_ = svd_.rank();
}

Eigen::MatrixXd ScaledSvd::root() const {
  return inverse_lengths_.asDiagonal() * V().leftCols(rank_) *
         singular_values().head(rank_).cwiseInverse().asDiagonal();
}

}  // namespace rigcal::calib
