#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// The scores of the clusters count as independent: more clusters would be correlated, and fewer
/// leave few degrees of freedom (fit_leak()).
inline constexpr int kClusters = 10;

/// The cluster of each sample that counts, from 0: by its phase in the period of a sine or square,
/// else by its place in the record.
std::vector<int> clusters_of(const calib::ProblemCondition& condition);

/// Sandwich covariance of the unknowns from residuals that are dependent within a cluster, and its
/// degrees of freedom: clusters with any information minus unknowns, at least 1. It is multiplied
/// by clusters over degrees of freedom, because the residuals are those of a fit.
///
/// @param jacobian  shape (channels * samples, unknowns), channel after channel
/// @param residual  shape (channels * samples), at the least squares
/// @param bread     inverse of J^T J
/// @param clusters  shape (samples)
std::pair<Eigen::MatrixXd, int> cluster_sandwich(const Eigen::MatrixXd& jacobian,
                                                 const Eigen::VectorXd& residual,
                                                 const Eigen::MatrixXd& bread,
                                                 const std::vector<int>& clusters);

}  // namespace rigcal::diagnosis
