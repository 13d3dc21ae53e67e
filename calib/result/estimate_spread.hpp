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
  /// Estimates that one condition has for itself.
  struct Own {
    std::vector<Estimate> estimates;
    /// S of their covariance with `estimates`, which come after them; shape (both, columns).
    Eigen::MatrixXd root;
  };

  std::vector<Estimate> estimates;
  /// S with S S^T their covariance, SI. Shape (estimates, columns).
  Eigen::MatrixXd root;
  /// Where there are many of them: no simulation knows those of two conditions.
  std::vector<Own> own = {};
};

/// R with R R^T = M, of a positive semidefinite matrix that rounding may have left without.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& m);

}  // namespace rigcal::calib
