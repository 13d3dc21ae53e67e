#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// Joint covariance of the estimates of a fit, for predictions.
struct EstimateSpread {
  /// One estimate, by which a condition finds those that act in it.
  struct Estimate {
    int index = 0;  ///< row of the plant's parameter table
    datasets::Scope scope = datasets::Scope::rig;
    std::string level;
  };
  std::vector<Estimate> estimates;
  /// S with S S^T their covariance, SI. Shape (estimates, columns).
  Eigen::MatrixXd root;
};

/// R with R R^T = M, of a positive semidefinite matrix that rounding may have left without.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& m);

}  // namespace rigcal::calib
