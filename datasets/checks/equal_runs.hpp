#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rigcal::datasets {

/// A maximal run of samples with exactly the same value.
struct EqualRun {
  std::size_t begin = 0;
  std::size_t length = 1;
  double value = 0.0;

  std::size_t end() const { return begin + length; }
};

/// Splits a signal into its runs, in order. Their lengths add up to the length of the signal.
///
/// @param x  shape (n), finite
std::vector<EqualRun> equal_runs(std::span<const double> x);

/// Whether all samples are equal; true for an empty signal.
bool is_constant(std::span<const double> x);

/// Returns the step of the converter or of the printed digits: the smallest nonzero difference
/// between neighbours; 0 if all samples are equal.
double resolution(const std::vector<EqualRun>& runs);

/// Returns the median step from one value to the next; 0 if all samples are equal.
double typical_step(const std::vector<EqualRun>& runs);

/// Whether the signal moves before and after a run, as far as the record shows: the third sample
/// before it and the third after it differ from it by at least `least`.
///
/// @param x  shape (n), contains the run
bool cuts_a_motion(std::span<const double> x, const EqualRun& run, double least);

/// Whether the noise of the signal is well above its resolution, so that a working sensor never
/// gives the same value many times. The steps between values then go up and down: at least 5 % of
/// the values, and at least 30 of them, are larger or smaller than both neighbours, by four steps
/// of the resolution and by 1e-6 of the range (more than simulations round). In white noise, even
/// on top of slow motion, this applies to at least half of the values; in a smooth signal, only to
/// a few. The rounding of a converter alone causes differences of only two steps.
///
/// @param low, high  runs at or beyond these values are ignored
bool shows_noise(const std::vector<EqualRun>& runs, double low, double high);

}  // namespace rigcal::datasets
