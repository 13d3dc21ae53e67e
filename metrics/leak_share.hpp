#pragma once

#include <span>

namespace rigcal::metrics {

/// Mean of |y| over the time from the first sample to the last, y joined by straight lines: the
/// trapezoidal rule where y keeps its sign, and exact for the lines where it changes.
///
/// @param time_s  shape (n), n >= 2, increasing, need not be equidistant
/// @param signal  shape (n), any unit
/// @throws std::invalid_argument  sizes differ, n < 2, a value is not finite, times do not increase
/// @throws std::domain_error      the mean is beyond the largest double
double mean_absolute(std::span<const double> time_s, std::span<const double> signal);

/// Derivative of mean_absolute() where the signal changes along `slope`: exact for the lines, sign
/// changes included.
///
/// @param slope  shape (n): d signal / d (some parameter)
/// @throws       as mean_absolute()
double mean_absolute_slope(std::span<const double> time_s, std::span<const double> signal,
                           std::span<const double> slope);

/// Share of the servo flow that leaks: mean |Q_leak| / mean |Q_servo|, which is how the source
/// paper's percentages come out (it says "of the work flow"). Over whole periods of a periodic run;
/// which part of a run that is, is the caller's to choose.
///
/// @param time_s                shape (n), n >= 2, increasing
/// @param servo_flow            shape (n), any unit
/// @param leakage_flow          shape (n), same unit
/// @return                      dimensionless, >= 0
/// @throws std::invalid_argument  as mean_absolute()
/// @throws std::domain_error      no servo flow at all, so there is no share
double leak_share(std::span<const double> time_s, std::span<const double> servo_flow,
                  std::span<const double> leakage_flow);

}  // namespace rigcal::metrics
