#pragma once

#include <span>

#include "common/describe.hpp"

namespace rigcal::metrics {

/// Features of a residual that the source paper uses to classify leaks (Table 4), in the unit of
/// the residual.
struct ResidualFeatures {
  double mean = 0.0;  ///< mean |r|
  double rms = 0.0;   ///< sqrt(mean r^2)
  double std = 0.0;   ///< population standard deviation of |r|: sqrt(rms^2 - mean^2)
};

/// One T for each of these features of a position residual.
template <typename T>
struct ByFeature {
  T mean_m{}, rms_m{}, std_m{};
  RIGCAL_DESCRIBE(mean_m, rms_m, std_m)
};

/// @param residual  shape (n), n >= 2: leaking minus healthy position, eq. 14
/// @throws std::invalid_argument  if n < 2, or if a value is not finite
/// @throws std::domain_error      if a feature exceeds the largest double
ResidualFeatures residual_features(std::span<const double> residual);

}  // namespace rigcal::metrics
