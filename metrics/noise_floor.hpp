#pragma once

#include <span>

#include "common/describe.hpp"

namespace rigcal::metrics {

/// Scores of a perfect model, which is equal to the true signal, against the measured one.
struct NoiseFloor {
  double rho2 = 0.0;
  double ccc = 0.0;
  double absolute_error_percent = 0.0;
  RIGCAL_DESCRIBE(rho2, ccc, absolute_error_percent)
};

/// Computes how well a model can agree with a record, given the noise in the record. The record is
/// y = t + n: the truth t plus noise n that is independent of t, with zero mean and variance
/// sigma^2 = sd_of_mean^2. Averaged over draws, to O(1/n_samples),
///
///   var(y) = var(t) + sigma^2,  cov(y, t) = var(t),  mean y = mean t,  var(y - t) = sigma^2
///
/// so that for s = t
///
///   rho2 = 1 - sigma^2 / var(y)                                               (eq. 15)
///   ccc  = 2 cov(y, t) / (var(y) + var(t)) = 2 (var(y) - sigma^2) / (2 var(y) - sigma^2)  (eq. 17)
///   absolute error = 100 E|n| / (max y - min y), E|n| = sigma sqrt(2 / pi) for Gaussian noise
///
/// A single draw varies around these values. With x = sigma^2 / var(t), a model with its gain
/// increased by sqrt(1 + x) would reach ccc = 1 / sqrt(1 + x). This exceeds the 1 / (1 + x / 2) of
/// the truth by at most x^2 / 8, so models are compared with the score of the truth.
///
/// If sigma^2 >= var(y), the record is only noise, and rho2 and ccc are 0.
///
/// @param measured_mean  shape (n), n >= 2, mean of the repeats, any unit
/// @param sd_of_mean     standard deviation of each of its samples, same unit, >= 0
/// @throws std::invalid_argument  if n < 2, a value is not finite, or sd_of_mean is negative or not
///                                finite
/// @throws std::domain_error      if the record is constant, or if the absolute error exceeds the
///                                largest double
NoiseFloor noise_floor(std::span<const double> measured_mean, double sd_of_mean);

}  // namespace rigcal::metrics
