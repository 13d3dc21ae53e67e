#include "calib/result/estimate_spread.hpp"

#include <Eigen/Eigenvalues>

namespace rigcal::calib {

Eigen::MatrixXd square_root(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace rigcal::calib
