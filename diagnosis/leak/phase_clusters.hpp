#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Number of clusters, whose scores count as independent. More clusters would be correlated, and
/// fewer would leave few degrees of freedom (fit_leak()).
inline constexpr int kClusters = 10;

/// Returns the cluster of each sample that counts, from 0, according to its phase in the period of
/// a sine or square, or otherwise to its position in the record.
std::vector<int> clusters_of(const calib::ProblemCondition& condition);

/// Sandwich covariance of the unknowns for residuals that are dependent within a cluster, and its
/// degrees of freedom: the number of clusters with any information minus the number of unknowns, at
/// least 1. The covariance is multiplied by the number of clusters divided by the degrees of
/// freedom, because the residuals are those of a fit.
///
/// @param jacobian  shape (channels * samples, unknowns), channel after channel
/// @param residual  shape (channels * samples), at the least-squares solution
/// @param bread     inverse of J^T J
/// @param clusters  shape (samples)
std::pair<Eigen::MatrixXd, int> cluster_sandwich(const Eigen::MatrixXd& jacobian,
                                                 const Eigen::VectorXd& residual,
                                                 const Eigen::MatrixXd& bread,
                                                 const std::vector<int>& clusters);

}  // namespace rigcal::diagnosis
