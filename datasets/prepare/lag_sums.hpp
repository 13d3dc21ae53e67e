#pragma once

#include <span>
#include <vector>

namespace rigcal::datasets {

// These sums take most of the time of an alignment, so several are computed at once in registers.
// Each is added up in the same order on every processor, so that results agree to the last bit.

/// Returns the sum of fixed[i] moving[i + k] over all i for which both exist, for each k in [first,
/// last].
///
/// @param first  >= 0
/// @param last  < length of `moving`
std::vector<double> shifted_products(std::span<const double> fixed, std::span<const double> moving,
                                     int first, int last);

/// Returns the sum over j of kernel[j] x[i + j] for each i at which the kernel fits. Shape (x -
/// kernel + 1); empty if the kernel is longer than x.
std::vector<double> weighted_sums(std::span<const double> x, std::span<const double> kernel);

}  // namespace rigcal::datasets
