#pragma once

#include <span>

namespace rigcal::metrics {

/// Rms of a zero-mean error for which rho2 is exactly at its limit: sqrt((1 - limit) var(y)), in
/// the unit of y.
///
/// @param measured  shape (n)
/// @return          0 for n < 2, and for a limit of 1 or more
/// @throws std::invalid_argument  if a value is not finite
double allowed_rms(std::span<const double> measured, double rho2_limit);

}  // namespace rigcal::metrics
