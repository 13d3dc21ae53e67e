#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// Where one period of a sine or square drive is sampled: one piece of a sine, two of a square,
/// each from behind a jump to just before the next, so that no interval spans a jump. In a square's
/// pieces the samples stand the denser the nearer they are to the jump that they follow.
struct PeriodGrid {
  std::vector<double> offset_s;  ///< from the start of the period, increasing
  std::size_t pieces = 1;        ///< of equal number of samples, one after another
};

/// @param intervals  per piece, even
PeriodGrid period_grid(datasets::Waveform waveform, double period_s, int intervals);

/// Mean of |y| over the period: of the pieces, which are equally long.
///
/// @param signal  shape (offset_s)
/// @param stride  1: all samples; 2: every other one, to see what the sampling does
double mean_absolute(const PeriodGrid& grid, std::span<const double> signal,
                     std::size_t stride = 1);

/// Derivative of that mean along dy.
double mean_absolute_slope(const PeriodGrid& grid, std::span<const double> signal,
                           std::span<const double> signal_slope);

}  // namespace rigcal::calib
