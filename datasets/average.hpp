#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

struct AverageOptions {
  bool align = true;  ///< shift repeats by the cross-correlation of their driving or fastest channel
  /// A repeat whose rms distance from the mean of the others exceeds this many times the median of
  /// these distances is named an outlier. It is never dropped silently: it stays in the mean.
  double outlier_ratio = 3.0;
  std::map<Channel, double> known_sd;  ///< the campaign's `sd` of a sample, where given
  int repeats_averaged = 1;            ///< repeats already averaged in a single file
};

/// Aligned mean, sd and count of any number of repeats of one condition. Repeats may carry
/// different channels; each channel is averaged over those that carry it. Repeats are resampled to
/// the time base of the first by the fractional shift found; samples at the ends that not every
/// repeat covers have a smaller count.
///
/// @throws std::invalid_argument  no repeat, or repeats of incompatible sampling (message says which)
Record average(const std::string& condition, const std::vector<Repeat>& repeats,
               const AverageOptions& options);

/// Delay of b against a by sub-sample cross-correlation: the lag (in samples, fractional) that
/// maximises the normalised cross-correlation, positive if b is late. Empty where the signals are
/// constant or the maximum lies at the edge of the search.
std::optional<double> lag_in_samples(const std::vector<double>& a, const std::vector<double>& b,
                                     int max_lag);

}  // namespace rigcal::datasets
