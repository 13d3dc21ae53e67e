#pragma once

namespace rigcal::diagnosis {

/// Whether a variance that is known with `freedom` degrees of freedom exceeds that of white noise
/// beyond the upper quartile of chi-square. Where it does it counts, else the noise: at that level
/// the choice between two variances leaves the coverage of an interval near 95 % whatever their
/// true ratio is (Bancroft and Han, International Statistical Review 45, 1977).
bool exceeds_noise(double variance, double noise_variance, double freedom);

}  // namespace rigcal::diagnosis
