#pragma once

#include <optional>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// The step of a channel's converter where its noise is too small to smooth it out: below half a
/// step every repeat is rounded alike, and their mean and their scatter know nothing of that error
/// (Widrow and Kollar, Quantization Noise, 2008, ch. 9: the bias of the mean is q / pi
/// exp(-2 pi^2 sigma^2 / q^2) at most). Empty where the noise suffices, or values lie on no grid.
///
/// @param repeats   as recorded
/// @param noise_sd  of a sample of one repeat, rounding included; > 0
std::optional<double> coarse_step(const std::vector<Repeat>& repeats, Channel channel,
                                  double noise_sd);

}  // namespace rigcal::datasets
