#pragma once

#include <span>
#include <vector>

namespace rigcal::metrics {

/// Mean of |y| from the first sample to the last, with y interpolated linearly. Where y keeps its
/// sign, this is the trapezoidal rule. Where y changes sign, the integral is exact for the straight
/// line.
///
/// @param time_s  shape (n), n >= 2, increasing, need not be equidistant
/// @param signal  shape (n), any unit
/// @throws std::invalid_argument  if sizes differ, n < 2, a value is not finite, or times do not
///                                increase
/// @throws std::domain_error      if the mean exceeds the largest double
double mean_absolute(std::span<const double> time_s, std::span<const double> signal);

/// Derivative of mean_absolute() with respect to each sample, shape (n). Exact for the interpolated
/// signal, including its changes of sign.
///
/// @throws std::invalid_argument, std::domain_error  under the conditions of mean_absolute()
std::vector<double> mean_absolute_weights(std::span<const double> time_s,
                                          std::span<const double> signal);

/// Derivative of mean_absolute() with respect to a parameter of the signal.
///
/// @param slope  shape (n): derivative of the signal with respect to the parameter
/// @throws std::invalid_argument, std::domain_error  under the conditions of mean_absolute()
double mean_absolute_slope(std::span<const double> time_s, std::span<const double> signal,
                           std::span<const double> slope);

}  // namespace rigcal::metrics
