#pragma once

#include <vector>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Solves a least-squares problem in the unit box with Ceres (trust region, dense QR). Starts at z
/// and stores the end point in z. Exceptions from the callbacks are passed on to the caller.
///
/// @param residuals     number of residuals
/// @param active_bound  marks the unknowns that keep their values
Descent descend(const DescentOptions& options, Eigen::Index residuals,
                const std::vector<bool>& active_bound, std::vector<double>& z);

}  // namespace rigcal::calib
