#pragma once

#include <optional>
#include <vector>

#include "diagnosis/record/leak_fit.hpp"
#include "metrics/significance.hpp"

namespace rigcal::diagnosis {

/// Leak fitted to a single repeat.
struct SingleFit {
  const LeakFit* fit = nullptr;
  /// For a healthy repeat, the number of other repeats that correct it.
  int corrected_by = 0;
};

/// Errors of a leak that only the records of one signal together reveal. They are expressed as RMS
/// changes in position, so that they apply to all leak levels.
struct SignalErrors {
  /// Standard deviation of a single repeat about the mean of its condition, pooled over conditions.
  std::optional<double> repeat_m;
  int repeat_freedom = 0;
  double repeat_noise_m = 0.0;  ///< contribution of white noise to repeat_m
  /// Component of repeat_m that is not noise, or 0 if noise alone may explain repeat_m
  /// (separate_noise()).
  std::optional<double> between_m;
  /// True if the residuals of the signal's records contain more than white noise.
  bool misfit = false;
  /// Variance that the residuals of an average cause in its error, over that of white noise: mean
  /// of the signal's averages (of its single repeats if it has no other), and its effective degrees
  /// of freedom. Above 1 only with a misfit.
  double residual_ratio = 1.0;
  double residual_freedom = metrics::kManyDegrees;
  /// Apparent leak of healthy records if they do not correct other records. Terms that the model
  /// lacks look like a leak of this size.
  std::optional<double> healthy_m;
};

/// Computes the errors of a signal. separate_noise() must complete those that depend on noise.
///
/// @param singles   fits of single repeats, condition by condition; conditions with only one repeat
///                  are ignored
/// @param healthy   fits of the averages of healthy conditions
/// @param averages  fits of all averages that are not their own reference
SignalErrors signal_errors(const std::vector<std::vector<SingleFit>>& singles,
                           const std::vector<const LeakFit*>& healthy,
                           const std::vector<const LeakFit*>& averages);

/// Returns true if the error of a record follows from the clusters of its residuals rather than
/// from white noise.
bool is_coloured(const LeakFit& fit, const SignalErrors& errors);

/// Sets the components beyond noise for all signals. First, all signals together are tested for
/// whether repeats differ at all, because the causes act on all of them; then each signal is
/// tested. Separate tests alone, with few degrees of freedom, would find a difference in a quarter
/// of the signals by chance.
void separate_noise(const std::vector<SignalErrors*>& signals);

/// Returns the fraction of the structured parity residual's power that a leak does not explain.
/// Returns 0 if the remaining residual does not exceed the noise, or does not exceed twice that of
/// healthy records.
///
/// @param healthy_m  RMS of the structured residual of healthy records relative to the healthy
///                   model
double unexplained_share(const LeakFit& fit, double healthy_m);

}  // namespace rigcal::diagnosis
