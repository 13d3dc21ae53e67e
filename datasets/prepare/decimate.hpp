#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Zero-phase low-pass for a record before only every `factor`-th sample is kept: a sinc under a
/// Kaiser window, of odd length 2 half + 1. With the new sample rate F it passes up to 0.4 F within
/// 0.1 %, halves the amplitude at 0.5 F and leaves less than 0.1 % above 0.6 F, so that aliases are
/// above 0.4 F.
struct AntiAliasFilter {
  std::size_t factor = 1;
  std::vector<double> taps;  ///< symmetric, of sum 1

  /// Factor on the standard deviation of white noise: sqrt(sum of squared taps).
  double noise_gain() const;
};

/// @param factor  > 1
AntiAliasFilter anti_alias_filter(std::size_t factor);

/// y[k] = filtered x at sample k * factor. Beyond its ends a record is continued by reflection
/// through its last sample, which continues a slope.
std::vector<double> decimated(const std::vector<double>& x, const AntiAliasFilter& filter);

/// Mean of each `factor` samples from k * factor on. A piecewise constant signal keeps its
/// integral, and an edge its place, without the ringing of a sharp filter.
std::vector<double> decimated_hold(const std::vector<double>& x, std::size_t factor);

/// Whole factor between the sample rate of a record and a wanted rate, 1 if it is no denser.
///
/// @throws std::invalid_argument  sample times not equidistant, or no whole factor: says which
/// rates
///                                are possible
std::size_t decimation_factor(const Repeat& repeat, double rate_hz);

}  // namespace rigcal::datasets
