#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace rigcal::calib {

/// Returns the variance of each estimate relative to the variance it would have if all others were
/// known: the diagonal of the inverse correlation matrix (Belsley, Kuh, Welsch, Regression
/// Diagnostics, 1980, 3.1). Pairwise correlations are not enough, because an estimate may depend on
/// several others together.
///
/// @param correlation  shape (n, n), finite
/// @return             shape (n); infinite if the correlation matrix is singular
Eigen::VectorXd variance_inflation(const Eigen::MatrixXd& correlation);

/// Describes how strongly the estimates are correlated: the strongest pair, and every estimate
/// whose variance is inflated more than tenfold. Empty for fewer than two estimates.
///
/// @param names  shape (n)
std::string collinearity_words(const std::vector<std::string>& names,
                               const Eigen::MatrixXd& correlation);

}  // namespace rigcal::calib
