#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rigcal::datasets {

/// A maximal run of samples of exactly the same value.
struct EqualRun {
  std::size_t begin = 0;
  std::size_t length = 1;
  double value = 0.0;

  std::size_t end() const { return begin + length; }
};

/// All runs of a signal, in order; their lengths add up to its own.
///
/// @param x  shape (n), finite
std::vector<EqualRun> equal_runs(std::span<const double> x);

/// Whether all samples are the same, as far as there are any.
bool is_constant(std::span<const double> x);

/// The step of the converter or of the printed digits: the smallest difference of neighbours that
/// is not zero; 0 where all are equal.
double resolution(const std::vector<EqualRun>& runs);

/// Median of the steps from one value to the next; 0 where all are equal.
double typical_step(const std::vector<EqualRun>& runs);

/// Whether the signal moves before and after a run, as far as the record shows: three samples
/// before it and after it have at least this distance from it.
///
/// @param x  shape (n), of which the run is a part
bool cuts_a_motion(std::span<const double> x, const EqualRun& run, double least);

/// Whether the noise of the signal is well above its resolution, so that a working sensor never
/// gives the same value many times. The steps between values then go up and down: at least 5 % of
/// the values, and 30 of them, are larger or smaller than both their neighbours, by four steps of
/// the resolution and by 1e-6 of the range (the rounding of simulations is less). In white noise
/// this is half of them or more, whatever slow motion is below it; in a smooth signal only a few.
/// The rounding of a converter alone causes a difference of two steps.
///
/// @param low, high  runs at or beyond these values are left out
bool shows_noise(const std::vector<EqualRun>& runs, double low, double high);

}  // namespace rigcal::datasets
