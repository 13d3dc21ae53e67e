#pragma once

#include <Eigen/Core>
#include <vector>

namespace rigcal::calib {

/// Moments of a normal distribution, truncated or not.
struct NormalMoments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Mean and covariance of a normal distribution some of whose components cannot be negative, by
/// expectation propagation: each constraint becomes a normal factor that gives its component the
/// moments of a normal distribution truncated at zero (T. P. Minka, Expectation propagation for
/// approximate Bayesian inference, UAI 2001). Exact for a single constraint, and for independent
/// ones.
///
/// @param never_negative  indices of these components in `normal`
NormalMoments cut_at_zero(NormalMoments normal, const std::vector<Eigen::Index>& never_negative);

}  // namespace rigcal::calib
