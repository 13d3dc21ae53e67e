#pragma once

#include <cstddef>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Zero-phase low-pass filter to be applied before keeping only every `factor`-th sample of a
/// record: a sinc with a Kaiser window, of odd length 2 half + 1. With F the new sample rate, it
/// passes frequencies up to 0.4 F within 0.1 %, halves the amplitude at 0.5 F and leaves less than
/// 0.1 % above 0.6 F, so that aliases appear only above 0.4 F.
struct AntiAliasFilter {
  std::size_t factor = 1;
  std::vector<double> taps;  ///< symmetric, with a sum of 1

  /// Returns the factor by which the filter changes the standard deviation of white noise: sqrt(sum
  /// of squared taps).
  double noise_gain() const;
};

/// @param factor  > 1
AntiAliasFilter anti_alias_filter(std::size_t factor);

/// Returns y[k] = filtered x at sample k * factor. Beyond its ends, a record is extended by
/// reflection through its end sample, so that a slope continues.
std::vector<double> decimated(const std::vector<double>& x, const AntiAliasFilter& filter);

/// Returns the mean of each block of `factor` samples, starting at sample k * factor. A piecewise
/// constant signal keeps its integral and the position of its edges, without the ringing of a sharp
/// filter.
std::vector<double> decimated_hold(const std::vector<double>& x, std::size_t factor);

/// Returns the ratio of a record's sample rate to the wanted rate, a whole number; 1 if the record
/// is not faster.
///
/// @throws std::invalid_argument  if the sample times are not equidistant, or if the ratio is not a
///                         whole number; the message says which rates are possible
std::size_t decimation_factor(const Repeat& repeat, double rate_hz);

}  // namespace rigcal::datasets
