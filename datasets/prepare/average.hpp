#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// End of every warning about an outlier.
inline constexpr std::string_view kStaysInMean = "it stays in the mean";

struct AverageOptions {
  bool align = true;  ///< align repeats by cross-correlating their drive or fastest channel
  /// A repeat is reported as an outlier if its rms distance from the sample-wise median of all
  /// repeats exceeds this many times the median of these distances. It is never dropped silently
  /// but kept in the mean. (Distances from the mean would not reveal an outlier among three or four
  /// repeats, because it pulls the mean towards itself.)
  double outlier_ratio = 3.0;
  std::map<Channel, double> known_sd;  ///< `sd` of a sample, where the campaign states it
  int repeats_averaged = 1;            ///< number of repeats already averaged in a single file
  double drive_hz = 0.0;               ///< frequency of a periodic drive; 0 if there is none
  bool keep_deviations = false;        ///< fill Series::deviations, for the errors of the repeats
};

/// Aligns any number of repeats of one condition, and computes their mean, sd and count. Repeats
/// may have different channels; each channel is averaged over the repeats that have it. Repeats are
/// resampled to the time base of the first one by the fractional shift found (alignment.hpp:
/// offsets are relative to their mean). Samples at the ends that not every repeat covers have a
/// smaller count. Samples that a channel does not cover at all are cut off.
///
/// A channel's standard deviation comes from its repeats. For a single repeat, or identical ones,
/// it is `known_sd`, the standard deviation of the samples in the file, which is then also that of
/// the mean. Without `known_sd` it is unknown. Resampling keeps 97 % to 100 % of the standard
/// deviation of white noise (resample.hpp).
///
/// @throws std::invalid_argument  if there is no repeat, or if the repeats have incompatible
///                         sampling; the message names them
Record average(const std::string& condition, const std::vector<Repeat>& repeats,
               const AverageOptions& options);

}  // namespace rigcal::datasets
