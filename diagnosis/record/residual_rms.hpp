#pragma once

#include <vector>

namespace rigcal::diagnosis {

/// Returns the root mean square; 0 for an empty vector.
double rms(const std::vector<double>& x);

/// Returns the standard deviation of the component that is independent from sample to sample,
/// estimated from differences between successive samples (J. von Neumann, Ann. Math. Stat. 12,
/// 1941); 0 for fewer than two samples.
double noise_rms(const std::vector<double>& x);

/// Returns the RMS of the component of a residual that is not independent in each sample; 0 if
/// there is only noise.
double structured_rms(double all, double noise);

}  // namespace rigcal::diagnosis
