#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rigcal::metrics {

/// 95 % intervals for a gain and a phase estimated from the same lines.
struct ResponseInterval {
  double gain_low = 0.0;        ///< >= 0
  double gain_high = 0.0;       ///< > gain_low
  double phase_half_deg = 0.0;  ///< at most 180; 180 if the phase is unknown
};

/// Ratio of output to input at one frequency, estimated by least squares from several independent
/// pairs of their complex amplitudes (periods, or neighbouring lines of a spectrum): H = S_uy /
/// S_uu.
struct ResponsePoint {
  double frequency_hz = 0.0;
  double gain = 0.0;         ///< |H|, unit of the output divided by that of the input
  double phase_deg = 0.0;    ///< in (-180, 180]; negative if the output lags
  double coherence = 1.0;    ///< |S_uy|^2 / (S_uu S_yy), in [0, 1]; 1 for a single pair
  double independent = 1.0;  ///< effective number of independent pairs
  /// From Student's t with 2 (pairs - 1) degrees of freedom. Absent with fewer than two pairs,
  /// which give no variance, and at a coherence of 0, where the interval has no upper end.
  std::optional<ResponseInterval> interval;
};

/// Minimum coherence for reporting a frequency response. Below it, at least 40 % of the output
/// power comes from something other than the input. Tischler and Remple, Aircraft and Rotorcraft
/// System Identification, 2nd ed., AIAA 2012, chapter 7.
inline constexpr double kLeastCoherence = 0.6;

/// Computes the response from a periodically driven record, at the fundamental of the drive and at
/// its odd harmonics up to the fifteenth. A harmonic is included if its amplitude in the input is
/// at least a hundredth of the fundamental's, and the record has at least four samples per cycle.
/// Each whole period, counted from the end of the record, is one pair. If there are three or more,
/// the first is left out as a transient.
///
/// @param time_s        shape (n), increasing; need not be equidistant
/// @param input         shape (n), any unit
/// @param output        shape (n), any unit
/// @param frequency_hz  frequency of the drive, > 0
/// @return              in order of frequency; empty if the input does not move at this frequency,
///                      or if the output does not move at all
/// @throws std::invalid_argument  if sizes differ, there is less than one period or fewer than 8
///                                samples in it, a value is not finite, or times do not increase
std::vector<ResponsePoint> periodic_response(std::span<const double> time_s,
                                             std::span<const double> input,
                                             std::span<const double> output, double frequency_hz);

/// Computes the response from a record with any other drive, such as a sweep, steps or noise. Both
/// signals are differenced, which preserves their ratio and removes drift. They are then tapered
/// over a tenth of the record at each end and transformed. The products of their spectral lines are
/// averaged in bins of equal width in log frequency, with at least eight lines each. A bin is left
/// out if the input's power density there is less than a millionth of its maximum.
///
/// @param sample_interval_s  > 0; samples are equidistant
/// @param input   shape (n), n >= 64, any unit
/// @param output  shape (n), any unit
/// @return        in order of frequency, up to 80 % of half the sampling rate
/// @throws std::invalid_argument  if sizes differ, n < 64, or a value or the interval is not finite
std::vector<ResponsePoint> broadband_response(double sample_interval_s,
                                              std::span<const double> input,
                                              std::span<const double> output);

/// Rms values of a signal after its mean has been removed, in bins of equal width in log frequency.
/// Bins without a line of the spectrum are left out; shape (remaining bins).
struct BandLevels {
  std::vector<double> frequency_hz;  ///< mean frequency of the lines in the bin
  std::vector<double> rms;           ///< in the unit of the signal
};

/// @param signal           shape (n), equidistant
/// @param rate_hz          > 0, samples per second
/// @param bins_per_decade  > 0
BandLevels band_levels(std::span<const double> signal, double rate_hz, double bins_per_decade);

}  // namespace rigcal::metrics
