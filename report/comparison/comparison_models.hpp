#pragma once

#include <optional>
#include <vector>

#include "report/comparison/comparison.hpp"

namespace rigcal::report {

/// Compares the models of the other results with that of the first. The entry for the first result
/// is std::nullopt. Every other entry has the information criteria relative to the first. The
/// likelihood-ratio test is added if the models are nested: all free parameters of one fit are also
/// free in the other, and everything else is equal. `reason` explains a missing number, such as
/// different records or weights, or a fit that did not converge.
///
/// @throws InputError  if a result contains impossible counts
std::vector<std::optional<StoredModelChoice>> compared_models(const std::vector<Compared>& results);

}  // namespace rigcal::report
