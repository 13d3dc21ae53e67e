#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// The end of what a record's warning says of an outlier.
inline constexpr std::string_view kStaysInMean = "it stays in the mean";

struct AverageOptions {
  bool align =
      true;  ///< shift repeats by the cross-correlation of their driving or fastest channel
  /// A repeat is reported as an outlier if its rms distance from the sample-wise median of all
  /// exceeds this many times the median of these distances. It is never dropped silently: it stays
  /// in the mean. (The mean would hide an outlier among three or four repeats, since it is halfway
  /// to it.)
  double outlier_ratio = 3.0;
  std::map<Channel, double> known_sd;  ///< the campaign's `sd` of a sample, where given
  int repeats_averaged = 1;            ///< repeats already averaged in a single file
  double drive_hz = 0.0;               ///< frequency of a periodic drive; 0 if there is none
  bool keep_deviations = false;        ///< Series::deviations, for the errors of the repeats
};

/// Aligned mean, sd and count of any number of repeats of one condition. Repeats may carry
/// different channels; each channel is averaged over those that carry it. Repeats are resampled to
/// the time base of the first by the fractional shift found (alignment.hpp: offsets are relative to
/// their mean); samples at the ends that not every repeat covers have a smaller count, and those
/// that a channel does not cover at all are cut off.
///
/// A channel's standard deviation comes from its repeats. With a single repeat, or identical ones,
/// it is the `known_sd` of the samples in the file, which is that of the mean too; else unknown.
/// Resampling leaves 97 % to 100 % of the standard deviation of white noise (resample.hpp).
///
/// @throws std::invalid_argument  no repeat, or repeats of incompatible sampling (message says
/// which)
Record average(const std::string& condition, const std::vector<Repeat>& repeats,
               const AverageOptions& options);

/// Delay of b against a by sub-sample cross-correlation: the lag (in samples, fractional) that
/// maximises the normalised cross-correlation, positive if b is late. Empty if the signals are
/// constant or the maximum is at the edge of the search.
std::optional<double> lag_in_samples(const std::vector<double>& a, const std::vector<double>& b,
                                     int max_lag);

}  // namespace rigcal::datasets
