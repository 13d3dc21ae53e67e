#pragma once

#include <optional>
#include <vector>

#include "report/comparison/comparison.hpp"

namespace rigcal::report {

/// Which model the records prefer, per result: nothing for the first, and for each other one its
/// information criteria against the first. Where all that is free in one fit is free in the other
/// too, and everything else is the same, the likelihood-ratio test with it. `reason` says why there
/// is no number: other records or weights, a fit that did not converge.
///
/// @throws InputError  a result counts what cannot be
std::vector<std::optional<StoredModelChoice>> compared_models(const std::vector<Compared>& results);

}  // namespace rigcal::report
