#pragma once

#include <optional>
#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/estimate_covariance.hpp"

namespace rigcal::calib {

/// Data of an earlier fit whose values are validated.
struct Origin {
  std::set<std::string> estimated_from;  ///< conditions whose records the fit used
  Aspect parameters;                     ///< how that fit judged its parameters
  /// Covariance of the values; absent if that fit did not converge.
  std::optional<EstimateCovariance> covariance;
};

}  // namespace rigcal::calib
