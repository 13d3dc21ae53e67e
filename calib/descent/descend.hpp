#pragma once

#include <vector>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Least squares in the unit box by Ceres, from z to where it ends: trust region, dense QR. What
/// the functions throw is thrown again, past Ceres.
///
/// @param residuals     how many
/// @param active_bound  unknowns that stay where they are
Descent descend(const DescentOptions& options, Eigen::Index residuals,
                const std::vector<bool>& active_bound, std::vector<double>& z);

}  // namespace rigcal::calib
