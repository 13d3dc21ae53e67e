#pragma once

#include <optional>
#include <vector>

#include "diagnosis/leak/leak_fit.hpp"

namespace rigcal::diagnosis {

/// Leak of a single repeat.
struct SingleFit {
  const LeakFit* fit = nullptr;
  /// For a healthy repeat: number of other repeats of the reference that correct it.
  int corrected_by = 0;
};

/// Errors of a leak that the records of one signal show together, as an rms change of position, so
/// that they apply to all leak levels.
struct SignalErrors {
  /// Standard deviation of a single repeat about the mean of its condition, pooled.
  std::optional<double> repeat_m;
  int repeat_freedom = 0;
  double repeat_noise_m = 0.0;  ///< contribution of the white noise of each record
  /// The part of it that is not noise; 0 where it is no more than noise may be (separate_noise()).
  std::optional<double> between_m;
  /// Residuals of the signal's records are more than white noise.
  bool misfit = false;
  /// Apparent leak of healthy records if they correct nothing: terms that the model lacks look like
  /// a leak of this size.
  std::optional<double> healthy_m;
};

/// Errors of a signal; separate_noise() completes those due to noise.
///
/// @param singles   fits of single repeats, condition by condition; one alone shows nothing
/// @param healthy   fits of the averages of healthy conditions
/// @param averages  fits of all averages that are not their own reference
SignalErrors signal_errors(const std::vector<std::vector<SingleFit>>& singles,
                           const std::vector<const LeakFit*>& healthy,
                           const std::vector<const LeakFit*>& averages);

/// Sets the parts beyond noise for all signals. Whether repeats differ at all is first tested for
/// all signals together, because the causes act on all; then for each signal. A test with few
/// degrees of freedom for each signal alone would find a difference in a quarter of them by chance.
void separate_noise(const std::vector<SignalErrors*>& signals);

/// Fraction of the structured parity residual's power that a leak does not explain; 0 if no more
/// than noise is left, or no more than twice the residual of healthy records.
///
/// @param healthy_m  structured rms residual of healthy records from the healthy model
double unexplained_share(const LeakFit& fit, double healthy_m);

}  // namespace rigcal::diagnosis
