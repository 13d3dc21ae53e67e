#pragma once

#include <optional>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Step of a channel's converter if its noise is too small to smooth it out. Below half a step
/// every repeat is rounded alike, and neither their mean nor their differences show that error
/// (Widrow and Kollar, Quantization Noise, 2008, ch. 9: the bias of the mean is at most q / pi
/// exp(-2 pi^2 sigma^2 / q^2)). Empty if the noise is sufficient, or the values are on no grid.
///
/// @param repeats   as recorded
/// @param noise_sd  of a sample of one repeat, rounding included; > 0
std::optional<double> coarse_step(const std::vector<Repeat>& repeats, Channel channel,
                                  double noise_sd);

}  // namespace rigcal::datasets
