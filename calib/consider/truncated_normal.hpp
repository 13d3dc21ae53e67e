#pragma once

#include <Eigen/Core>
#include <vector>

namespace rigcal::calib {

/// Moments of a normal distribution, which may be truncated.
struct NormalMoments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Computes the mean and covariance of a normal distribution some of whose components cannot be
/// negative, by expectation propagation. Each constraint becomes a normal factor that gives its
/// component the moments of a normal distribution truncated at zero (T. P. Minka, Expectation
/// propagation for approximate Bayesian inference, UAI 2001). The result is exact for a single
/// constraint, and for independent ones.
///
/// @param never_negative  indices of the components that cannot be negative
NormalMoments cut_at_zero(NormalMoments normal, const std::vector<Eigen::Index>& never_negative);

}  // namespace rigcal::calib
