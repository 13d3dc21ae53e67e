#pragma once

#include <span>
#include <vector>

namespace rigcal::datasets {

// The sums that an alignment spends its time on, with several of them in registers at once. Each is
// added up in the same order on every processor, and so is the same to the last bit.

/// Sum over i of fixed[i] moving[i + k], as far as both reach, for each k of [first, last].
///
/// @param first  >= 0, @param last  < the length of `moving`
std::vector<double> shifted_products(std::span<const double> fixed, std::span<const double> moving,
                                     int first, int last);

/// Sum over j of kernel[j] x[i + j] for each i that the kernel covers: shape (x - kernel + 1),
/// empty where the kernel is longer.
std::vector<double> weighted_sums(std::span<const double> x, std::span<const double> kernel);

}  // namespace rigcal::datasets
