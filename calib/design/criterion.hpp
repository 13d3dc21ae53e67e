#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calib/problem/problem.hpp"
#include "datasets/campaign/design/design_settings.hpp"

namespace rigcal::calib {

/// How good a test is for the named unknowns, the others being estimated beside them; the larger
/// the better. `determinant`: minus half the logarithm of the determinant of their covariance.
/// `worst`: minus the logarithm of the largest standard deviation over its value (over the width of
/// the bounds where the value is 0).
///
/// @param rows   weighted sensitivities, one column per unknown in the unit box. Priors are added;
///               an unknown that the rows leave open counts with a uniform distribution within its
///               bounds, so that there is always a score
/// @param named  positions of the named unknowns, at least one
double design_score(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& rows,
                    const std::vector<std::size_t>& named, datasets::DesignCriterion criterion);

}  // namespace rigcal::calib
