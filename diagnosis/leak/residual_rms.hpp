#pragma once

#include <vector>

namespace rigcal::diagnosis {

/// Root mean square; 0 for an empty vector.
double rms(const std::vector<double>& x);

/// Standard deviation of the part that is independent from sample to sample, by the differences of
/// successive samples (J. von Neumann, Ann. Math. Stat. 12, 1941); 0 of fewer than two.
double noise_rms(const std::vector<double>& x);

/// The part of a residual that is not new in each sample; 0 where all is noise.
double structured_rms(double all, double noise);

}  // namespace rigcal::diagnosis
