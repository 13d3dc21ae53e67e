#pragma once

namespace rigcal::diagnosis {

/// Returns true if a variance with `freedom` degrees of freedom exceeds the variance of white noise
/// by so much that the ratio is in the upper quartile of chi-square. Callers then use this
/// variance, and otherwise the variance of the noise. At this level, choosing between two variances
/// keeps the coverage of an interval close to 95 % for any true ratio (Bancroft and Han,
/// International Statistical Review 45, 1977).
bool exceeds_noise(double variance, double noise_variance, double freedom);

}  // namespace rigcal::diagnosis
