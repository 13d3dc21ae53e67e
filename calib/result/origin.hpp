#pragma once

#include <set>
#include <string>

#include "calib/result/aspect.hpp"

namespace rigcal::calib {

/// What an earlier fit, whose values are validated, tells of itself.
struct Origin {
  std::set<std::string> estimated_from;  ///< conditions whose records it was fitted to
  Aspect parameters;                     ///< as it judged them
};

}  // namespace rigcal::calib
