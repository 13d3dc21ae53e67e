#pragma once

#include <Eigen/Core>
#include <vector>

namespace rigcal::calib {

/// Moments of a normal distribution, or of one that is cut off.
struct NormalMoments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Mean and covariance where some components cannot be negative, by expectation propagation: each
/// constraint becomes a normal factor that gives its component the moments of a normal distribution
/// cut off at zero (T. P. Minka, Expectation propagation for approximate Bayesian inference, UAI
/// 2001). Exact for one constraint, or for independent ones.
///
/// @param never_negative  positions in `normal`
NormalMoments cut_at_zero(NormalMoments normal, const std::vector<Eigen::Index>& never_negative);

}  // namespace rigcal::calib
