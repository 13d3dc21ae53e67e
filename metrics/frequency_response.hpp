#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rigcal::metrics {

/// Half widths of a 95 % interval of a gain and a phase that were estimated from the same lines.
struct ResponseInterval {
  double gain_low = 0.0;        ///< >= 0
  double gain_high = 0.0;       ///< > gain_low
  double phase_half_deg = 0.0;  ///< at most 180: the phase is then unknown
};

/// Output over input at one frequency, estimated from several independent pairs of their complex
/// amplitudes (periods, or neighbouring lines of a spectrum) by least squares: H = S_uy / S_uu.
struct ResponsePoint {
  double frequency_hz = 0.0;
  double gain = 0.0;         ///< |H|, unit of the output over that of the input
  double phase_deg = 0.0;    ///< in (-180, 180]; negative where the output is late
  double coherence = 1.0;    ///< |S_uy|^2 / (S_uu S_yy), in [0, 1]; 1 where there is one pair alone
  double independent = 1.0;  ///< pairs, as many as would be independent
  /// By Student's t with 2 (pairs - 1) degrees of freedom. Absent with fewer than two pairs, which
  /// have no variance, and at coherence 0, where the interval has no upper end.
  std::optional<ResponseInterval> interval;
};

/// Below this coherence no frequency response is reported: about half of the output comes from
/// something else. Tischler and Remple, Aircraft and Rotorcraft System Identification, 2nd ed.,
/// AIAA 2012, chapter 7.
inline constexpr double kLeastCoherence = 0.6;

/// The response of a record that was driven periodically, at the fundamental of the drive and at
/// its odd harmonics up to the fifteenth, as far as the input has at least a hundredth of its
/// fundamental there and the record four samples per cycle. Each whole period at the end of the
/// record is one pair; the first is left out as transient where there are three or more.
///
/// @param time_s        shape (n), increasing; need not be equidistant
/// @param input         shape (n), any unit
/// @param output        shape (n), any unit
/// @param frequency_hz  > 0, of the drive
/// @return              by frequency; empty where the input does not move at this frequency, or
///                      the output does not move at all
/// @throws std::invalid_argument  sizes differ, less than one period or fewer than 8 samples in it,
///                                a value is not finite, times do not increase
std::vector<ResponsePoint> periodic_response(std::span<const double> time_s,
                                             std::span<const double> input,
                                             std::span<const double> output, double frequency_hz);

/// The response in a record with any other drive: sweep, steps or noise. Both signals are
/// differenced, which keeps their ratio and removes drifts, tapered over a tenth at either end, and
/// transformed. The products of their lines are averaged over bins of equal width in log frequency
/// with at least eight lines. A bin with less than a millionth of the input's largest power density
/// is left out.
///
/// @param sample_interval_s  > 0, equidistant
/// @param input   shape (n), n >= 64, any unit
/// @param output  shape (n), any unit
/// @return        by frequency, up to 80 % of half the sampling rate
/// @throws std::invalid_argument  sizes differ, n < 64, a value or the interval is not finite
std::vector<ResponsePoint> broadband_response(double sample_interval_s,
                                              std::span<const double> input,
                                              std::span<const double> output);

/// Root mean squares of a signal less its mean, in bins of equal width in log frequency; shape
/// (bins with a line of the spectrum).
struct BandLevels {
  std::vector<double> frequency_hz;  ///< mean of the lines
  std::vector<double> rms;           ///< in the unit of the signal
};

/// @param signal           shape (n), equidistant
/// @param rate_hz          > 0, samples per second
/// @param bins_per_decade  > 0
BandLevels band_levels(std::span<const double> signal, double rate_hz, double bins_per_decade);

}  // namespace rigcal::metrics
