#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Delay of one record against another.
struct Lag {
  double samples = 0.0;      ///< positive if the second record is late
  double sd_samples = 0.0;   ///< its standard deviation for white noise in both records
  double correlation = 0.0;  ///< height of the peak of the normalised cross-correlation
};

/// Delay of b against a: the maximum of the normalised cross-correlation, found between samples.
///
/// Both records are smoothed by the same Gaussian, which keeps a delay but not the noise; its width
/// is chosen for the smallest standard deviation. Among the peaks of a periodic record that noise
/// makes equal, the one with the smallest |lag| is taken, so that no period is ever skipped.
///
/// @param a, b     same sampling, any lengths; values finite
/// @param max_lag  [samples], > 0; no more than a third of the shorter record is searched
/// @return         empty: a record is constant, too short (64 samples), unlike the other, a
///                 sinusoid above 0.35 of the sample rate (its periods are indistinguishable), or
///                 the maximum is at the edge of the search
std::optional<Lag> find_lag(const std::vector<double>& a, const std::vector<double>& b,
                            int max_lag);

/// The same for several records against one, which is smoothed once for all of them.
std::vector<std::optional<Lag>> find_lags(const std::vector<double>& a,
                                          const std::vector<const std::vector<double>*>& others,
                                          int max_lag);

}  // namespace rigcal::datasets
