#pragma once

#include <cstddef>
#include <vector>

namespace rigcal::datasets {

/// A run of one or two samples that differs from its neighbours on both sides.
struct Spike {
  std::size_t sample = 0;  ///< index of the first sample in the run, from 0
  std::size_t length = 1;
  double height = 0.0;  ///< farthest sample minus the line between its neighbours; signed
};

/// Finds the spikes in a signal: runs of up to two samples that are on one side of the line between
/// their neighbours. Their distance from it must exceed three limits: ten standard deviations of
/// this distance for single samples of the signal (computed from the median, so that spikes do not
/// count), four times the median nonzero difference between neighbours (the step of a coarse
/// converter), and three times the difference between the neighbours of the run. An edge is not a
/// spike, since its neighbours differ.
///
/// There are none in 10^6 samples of white noise. Noise with long tails may have some.
///
/// @param x  shape (n), evenly sampled, finite
/// @return   in order; empty for fewer than 16 samples
std::vector<Spike> find_spikes(const std::vector<double>& x);

/// Returns `x` with each spike replaced by the line between the samples around it.
std::vector<double> without_spikes(std::vector<double> x, const std::vector<Spike>& spikes);

}  // namespace rigcal::datasets
