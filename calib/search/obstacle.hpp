#pragma once

#include <string>

#include "calib/search/optimum.hpp"

namespace rigcal::calib {

/// How far a point where a search ended is from a minimum, what keeps it there and what would cut
/// that, as the end of a sentence: the valley along which what is left of the way leads, by its
/// parameters, and the bounds that the cost presses against. Empty at a minimum.
std::string far_from_minimum(const Problem& problem, const Evaluation& evaluation,
                             const OptimumCheck& check);

}  // namespace rigcal::calib
