#pragma once

#include <vector>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Least squares in the unit box by Ceres (trust region, dense QR). Starts at z and leaves its end
/// point there. Exceptions of the functions pass through Ceres to the caller.
///
/// @param residuals     number of residuals
/// @param active_bound  unknowns that stay at their value
Descent descend(const DescentOptions& options, Eigen::Index residuals,
                const std::vector<bool>& active_bound, std::vector<double>& z);

}  // namespace rigcal::calib
