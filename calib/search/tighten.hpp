#pragma once

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Tightens the tolerance of the simulations tenfold, twice at most, and polishes again from the
/// best point, where every start stalls near a minimum because rounding of the simulations hides
/// the rest of the way, as in a direction that the records hardly determine. Does nothing where the
/// campaign fixes the tolerance.
///
/// @param problem  its tolerance is changed
/// @param found    optimum, result and report of its best start are those of the last round
/// @return         whether it did something
bool tighten_tolerance(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                       MultiStart& found);

}  // namespace rigcal::calib
