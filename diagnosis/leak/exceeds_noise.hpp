#pragma once

namespace rigcal::diagnosis {

/// Whether a variance with `freedom` degrees of freedom exceeds that of white noise beyond the
/// upper quartile of chi-square. If so, it is used, else that of the noise. At this level the
/// choice between two variances keeps the coverage of an interval near 95 % for any true ratio
/// (Bancroft and Han, International Statistical Review 45, 1977).
bool exceeds_noise(double variance, double noise_variance, double freedom);

}  // namespace rigcal::diagnosis
