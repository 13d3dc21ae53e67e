#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace rigcal::calib {

/// What the records say about the sizes e of the considered effects, linear about the optimum. All
/// sizes are multiples of the plausible size, with the prior N(0, 1), truncated at zero for an
/// effect that cannot be negative. The effects change the weighted outputs by E e = B C e + Q F e:
/// B are the rows of the directions that move the estimates, Q those of the directions beside them.
struct EffectLikelihood {
  std::vector<std::string> keys;
  std::vector<bool> one_sided;
  Eigen::MatrixXd taken;                ///< C, shape (directions of the root, effects)
  Eigen::MatrixXd felt;                 ///< F, shape (columns of Q, effects)
  Eigen::MatrixXd covariance;           ///< W, covariance of Q^T r
  std::vector<Eigen::MatrixXf> beside;  ///< Q, rows of each condition
  Eigen::VectorXd mean;                 ///< sizes from prior and records, truncated at zero
};

}  // namespace rigcal::calib
