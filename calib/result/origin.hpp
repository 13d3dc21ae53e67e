#pragma once

#include <optional>
#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/estimate_spread.hpp"

namespace rigcal::calib {

/// Data of an earlier fit whose values are validated.
struct Origin {
  std::set<std::string> estimated_from;  ///< conditions whose records the fit used
  Aspect parameters;                     ///< judgement of that fit
  std::optional<EstimateSpread> spread;  ///< for the values; absent without convergence
};

}  // namespace rigcal::calib
