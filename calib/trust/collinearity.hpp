#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace rigcal::calib {

/// Variance of each estimate relative to its variance if all others were known: the diagonal of the
/// inverse of the correlation (Belsley, Kuh, Welsch, Regression Diagnostics, 1980, 3.1). Pairs
/// alone do not show it: an estimate may depend on several others together.
///
/// @param correlation  shape (n, n), finite
/// @return             shape (n); infinite where the correlation is singular
Eigen::VectorXd variance_inflation(const Eigen::MatrixXd& correlation);

/// Describes how strongly estimates are correlated: the strongest pair, and every estimate whose
/// variance is inflated more than tenfold. Empty for fewer than two estimates.
///
/// @param names  shape (n)
std::string collinearity_words(const std::vector<std::string>& names,
                               const Eigen::MatrixXd& correlation);

}  // namespace rigcal::calib
