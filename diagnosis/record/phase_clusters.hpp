#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Number of clusters, whose scores are treated as independent. More clusters would be correlated,
/// and fewer would leave too few degrees of freedom (fit_leak()).
inline constexpr int kClusters = 10;

/// Returns the cluster of each sample that counts, from 0. It depends on the phase in the period of
/// a sine or square, or otherwise on the position in the record.
std::vector<int> clusters_of(const calib::ProblemCondition& condition);

/// Returns the sandwich covariance of the unknowns for residuals that are dependent within a
/// cluster, and its degrees of freedom: the number of clusters that contain information minus the
/// number of unknowns, but at least 1. The covariance is multiplied by the number of clusters
/// divided by the degrees of freedom, because the residuals are those of a fit.
///
/// @param jacobian  shape (channels * samples, unknowns), one channel after the other
/// @param residual  shape (channels * samples), at the least-squares solution
/// @param bread     inverse of J^T J
/// @param clusters  shape (samples)
std::pair<Eigen::MatrixXd, int> cluster_sandwich(const Eigen::MatrixXd& jacobian,
                                                 const Eigen::VectorXd& residual,
                                                 const Eigen::MatrixXd& bread,
                                                 const std::vector<int>& clusters);

}  // namespace rigcal::diagnosis
