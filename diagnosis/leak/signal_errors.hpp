#pragma once

#include <optional>
#include <vector>

#include "diagnosis/leak/leak_fit.hpp"

namespace rigcal::diagnosis {

/// Leak fitted to a single repeat.
struct SingleFit {
  const LeakFit* fit = nullptr;
  /// For a healthy repeat: number of other repeats in the reference that correct it.
  int corrected_by = 0;
};

/// Errors of a leak that only the records of one signal together reveal. They are expressed as an
/// rms change of position, so that they apply to all leak levels.
struct SignalErrors {
  /// Standard deviation of a single repeat around the mean of its condition, pooled.
  std::optional<double> repeat_m;
  int repeat_freedom = 0;
  double repeat_noise_m = 0.0;  ///< contribution of the white noise of each record
  /// Component of repeat_m that is not noise; 0 if noise alone may explain repeat_m
  /// (separate_noise()).
  std::optional<double> between_m;
  /// Whether the residuals of the signal's records are more than white noise.
  bool misfit = false;
  /// Apparent leak of healthy records if they do not correct others. Terms that the model lacks
  /// look like a leak of this size.
  std::optional<double> healthy_m;
};

/// Computes the errors of a signal. separate_noise() completes those that depend on noise.
///
/// @param singles   fits of single repeats, condition by condition; a single one shows nothing
/// @param healthy   fits of the averages of healthy conditions
/// @param averages  fits of all averages that are not their own reference
SignalErrors signal_errors(const std::vector<std::vector<SingleFit>>& singles,
                           const std::vector<const LeakFit*>& healthy,
                           const std::vector<const LeakFit*>& averages);

/// Sets the components beyond noise for all signals. Whether repeats differ at all is tested first
/// for all signals together, because the causes act on all of them, and then for each signal.
/// Testing each signal separately, with few degrees of freedom, would find a difference in a
/// quarter of them by chance.
void separate_noise(const std::vector<SignalErrors*>& signals);

/// Fraction of the structured parity residual's power that a leak does not explain. 0 if what is
/// left does not exceed the noise, or does not exceed twice the residual of healthy records.
///
/// @param healthy_m  structured rms residual of healthy records relative to the healthy model
double unexplained_share(const LeakFit& fit, double healthy_m);

}  // namespace rigcal::diagnosis
