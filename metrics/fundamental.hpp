#pragma once

#include <span>

namespace rigcal::metrics {

/// Complex amplitude of a signal at one frequency.
struct Fundamental {
  double amplitude = 0.0;  ///< >= 0, in the unit of the signal
  double phase_rad = 0.0;  ///< phase in A sin(2 pi f t + phase), in (-pi, pi]
};

/// Least-squares fit of a sin + b cos + c at `frequency_hz` over whole periods from the end of the
/// record (the last n whole periods; the first is dropped as transient if there are three or more).
/// Sample times need not be equidistant. A sample represents the interval before it, so that n
/// periods of m samples each are n periods, and a window never counts both of its ends.
///
/// @param time_s        shape (n), increasing
/// @param signal        shape (n), any unit
/// @param frequency_hz  > 0
/// @throws std::invalid_argument  less than one period, fewer than 4 samples (in the record or in
///                                the window), sizes differ, a value is not finite, times do not
///                                increase, frequency not positive, or samples that cannot separate
///                                the frequency from an offset (for example two per period)
Fundamental fundamental(std::span<const double> time_s, std::span<const double> signal,
                        double frequency_hz);

/// Gain and phase of a simulated signal relative to a measured one at the fundamental.
struct FundamentalComparison {
  double gain_ratio = 0.0;  ///< simulated amplitude over measured amplitude
  double phase_deg = 0.0;   ///< simulated phase minus measured phase, in (-180, 180]
  double delay_s = 0.0;     ///< delay of the simulation: -phase / (360 f)
};

/// @throws std::invalid_argument  as fundamental()
/// @throws std::domain_error      a signal has no component at this frequency (an amplitude below
///                                1e-12 of its peak-to-peak): a phase would be of rounding
FundamentalComparison compare_fundamentals(std::span<const double> time_s,
                                           std::span<const double> measured,
                                           std::span<const double> simulated, double frequency_hz);

}  // namespace rigcal::metrics
