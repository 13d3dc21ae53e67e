#pragma once

#include <Eigen/SVD>

// The decomposition takes longer to compile than most files that use it: svd.cpp does it for all.
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace rigcal::calib {

using Svd = Eigen::JacobiSVD<Eigen::MatrixXd>;

}  // namespace rigcal::calib
