#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calib/problem/problem.hpp"
#include "datasets/campaign/design/design_settings.hpp"

namespace rigcal::calib {

/// Scores how well a test determines the named unknowns when the other unknowns are estimated at
/// the same time. A larger score is better. For `determinant`, the score is minus half the
/// logarithm of the determinant of the covariance of the named unknowns. For `worst`, it is minus
/// the logarithm of the largest standard deviation relative to the value of the unknown (or to the
/// width of its bounds if the value is 0).
///
/// @param rows   weighted sensitivities, one column per unknown in the unit box. Priors are added.
///               An unknown that the rows do not determine gets a uniform distribution within its
///               bounds, so that there is always a score.
/// @param named  positions of the named unknowns, at least one
double design_score(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& rows,
                    const std::vector<std::size_t>& named, datasets::DesignCriterion criterion);

}  // namespace rigcal::calib
