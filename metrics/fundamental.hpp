#pragma once

#include <span>

namespace rigcal::metrics {

/// Complex amplitude of a signal at one frequency.
struct Fundamental {
  double amplitude = 0.0;  ///< >= 0, in the unit of the signal
  double phase_rad = 0.0;  ///< phase in A sin(2 pi f t + phase), in (-pi, pi]
};

/// Fits a sin + b cos + c at `frequency_hz` by least squares, over whole periods counted from the
/// end of the record. If there are three or more, the first is dropped as a transient. Sample times
/// need not be equidistant. A sample represents the interval before it, so that n periods of m
/// samples each are exactly n periods, and a window never counts both of its ends.
///
/// @param time_s        shape (n), increasing
/// @param signal        shape (n), any unit
/// @param frequency_hz  > 0
/// @throws std::invalid_argument  if there is less than one period, or fewer than 4 samples (in the
///                                record or in the window); if sizes differ, a value is not finite,
///                                times do not increase, or the frequency is not positive; or if
///                                the samples cannot separate the frequency from an offset (for
///                                example, two per period)
Fundamental fundamental(std::span<const double> time_s, std::span<const double> signal,
                        double frequency_hz);

/// Gain and phase of a simulated signal relative to a measured one, at the fundamental.
struct FundamentalComparison {
  double gain_ratio = 0.0;  ///< simulated amplitude over measured amplitude
  double phase_deg = 0.0;   ///< simulated phase minus measured phase, in (-180, 180]
  double delay_s = 0.0;     ///< delay of the simulation: -phase / (360 f)
};

/// @throws std::invalid_argument  under the conditions of fundamental()
/// @throws std::domain_error      if a signal has no component at this frequency (its amplitude is
///                                below 1e-12 of its peak-to-peak), so that its phase would be due
///                                to rounding
FundamentalComparison compare_fundamentals(std::span<const double> time_s,
                                           std::span<const double> measured,
                                           std::span<const double> simulated, double frequency_hz);

}  // namespace rigcal::metrics
