#pragma once

#include <optional>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

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
