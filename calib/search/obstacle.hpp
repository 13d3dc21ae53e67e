#pragma once

#include <string>

#include "calib/search/optimum.hpp"

namespace rigcal::calib {

/// Explains, as the end of a sentence, why a search ended away from a minimum: how much further the
/// cost would fall, which parameters form the valley that the remaining step follows, at which
/// bounds the cost still falls outwards, and what would help. Empty at a minimum.
std::string far_from_minimum(const Problem& problem, const Evaluation& evaluation,
                             const OptimumCheck& check);

}  // namespace rigcal::calib
