#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Sample times in one period of a sine or square drive. A sine has one piece, a square has two.
/// Each piece extends from just after a jump to just before the next, so that no interval spans a
/// jump. For a square, samples are denser just after a jump.
struct PeriodGrid {
  std::vector<double> offset_s;  ///< from the start of the period, increasing
  std::size_t pieces = 1;        ///< number of consecutive pieces with equal numbers of samples
};

/// @param intervals  number of intervals per piece; must be even
PeriodGrid period_grid(datasets::Waveform waveform, double period_s, int intervals);

/// Returns the mean of |signal| over the period, whose pieces have equal length.
///
/// @param signal  shape (offset_s)
/// @param stride  1: all samples; 2: every second one, to estimate the sampling error
double mean_absolute(const PeriodGrid& grid, std::span<const double> signal,
                     std::size_t stride = 1);

/// Returns the derivative of mean_absolute() in the direction `signal_slope`.
double mean_absolute_slope(const PeriodGrid& grid, std::span<const double> signal,
                           std::span<const double> signal_slope);

}  // namespace rigcal::diagnosis
