#pragma once

#include <string>

#include "calib/search/optimum.hpp"

namespace rigcal::calib {

/// Explains why a search ended away from a minimum, as the end of a sentence: how far the cost
/// would still fall, which parameters form the valley that the remaining step follows, which bounds
/// the cost presses against, and what would help. Empty at a minimum.
std::string far_from_minimum(const Problem& problem, const Evaluation& evaluation,
                             const OptimumCheck& check);

}  // namespace rigcal::calib
