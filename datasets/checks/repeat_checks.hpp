#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "datasets/record.hpp"

// Doubts about the repeats of a condition, as recorded.

namespace rigcal::datasets {

/// Finds repeats that have exactly the same samples of a measured channel, as when a file is given
/// twice: noise never repeats. A constant channel, a command or a reference proves nothing.
///
/// @param carriers  indices of the repeats that have the channel
/// @return          for each of them, the index within `carriers` of the first repeat identical to
///                  it; its own index if no earlier one is
std::vector<std::size_t> first_identical(const std::vector<Repeat>& repeats,
                                         const std::vector<std::size_t>& carriers, Channel channel);

/// Returns the step of a channel's converter if the noise is too small to smooth it out. With noise
/// below half a step, every repeat is rounded alike. The error then shows neither in the mean of
/// the repeats nor in their differences (Widrow and Kollar, Quantization Noise, 2008, ch. 9: the
/// bias of the mean is at most q / pi exp(-2 pi^2 sigma^2 / q^2)). Returns std::nullopt if there is
/// enough noise, or if the values are not a whole number of steps apart.
///
/// @param repeats  as recorded
/// @param noise_sd  standard deviation of a sample of one repeat, including rounding; > 0
std::optional<double> coarse_step(const std::vector<Repeat>& repeats, Channel channel,
                                  double noise_sd);

}  // namespace rigcal::datasets
