#pragma once

#include <optional>
#include <vector>

#include "report/comparison/comparison.hpp"

namespace rigcal::report {

/// Which model the records prefer, per result: nothing for the first; for each other one its
/// information criteria against the first. If all free parameters of one fit are free in the other,
/// too, and everything else is equal, the likelihood-ratio test is added. `reason` explains a
/// missing number: other records or weights, a fit that did not converge.
///
/// @throws InputError  a result has impossible counts
std::vector<std::optional<StoredModelChoice>> compared_models(const std::vector<Compared>& results);

}  // namespace rigcal::report
