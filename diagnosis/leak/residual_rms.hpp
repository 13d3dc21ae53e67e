#pragma once

#include <vector>

namespace rigcal::diagnosis {

/// Root mean square; 0 for an empty vector.
double rms(const std::vector<double>& x);

/// Standard deviation of the component that is independent from sample to sample, estimated from
/// differences of successive samples (J. von Neumann, Ann. Math. Stat. 12, 1941); 0 for fewer than
/// two samples.
double noise_rms(const std::vector<double>& x);

/// Rms of the component of a residual that is not independent in each sample; 0 if it is all noise.
double structured_rms(double all, double noise);

}  // namespace rigcal::diagnosis
