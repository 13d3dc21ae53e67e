#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace rigcal::calib {

/// How much larger the variance of each estimate is than with all others known: the diagonal of the
/// inverse of the correlation (Belsley, Kuh, Welsch, Regression Diagnostics, 1980, 3.1). Pairs
/// alone do not tell it: an estimate may be made up by several others together.
///
/// @param correlation  shape (n, n), finite
/// @return             shape (n); infinite where the correlation is singular
Eigen::VectorXd variance_inflation(const Eigen::MatrixXd& correlation);

/// What may be said of how well estimates are told apart: the strongest pair, and every estimate
/// whose variance is inflated more than tenfold. Empty with fewer than two.
///
/// @param names  shape (n)
std::string collinearity_words(const std::vector<std::string>& names,
                               const Eigen::MatrixXd& correlation);

}  // namespace rigcal::calib
