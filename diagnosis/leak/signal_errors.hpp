#pragma once

#include <optional>
#include <vector>

#include "diagnosis/leak/leak_fit.hpp"

namespace rigcal::diagnosis {

/// Leak of a single repeat.
struct SingleFit {
  const LeakFit* fit = nullptr;
  /// Where it is a healthy repeat: by how many others of the same reference it was corrected.
  int corrected_by = 0;
};

/// Errors of a leak that the records of one signal tell together, as an rms change of position, so
/// that they carry over from one leak level to another.
struct SignalErrors {
  /// Standard deviation of a single repeat about the mean of its condition, pooled.
  std::optional<double> repeat_m;
  int repeat_freedom = 0;
  double repeat_noise_m = 0.0;  ///< what the white noise of each record makes of it
  /// The part of it that is not noise; 0 where it is no more than noise may be (separate_noise()).
  std::optional<double> between_m;
  /// Residuals of the signal's records tell of more than white noise.
  bool misfit = false;
  /// Leak that healthy records seem to have, where they correct nothing: what the model lacks looks
  /// like a leak of this size.
  std::optional<double> healthy_m;
};

/// What it says of noise is to be completed by separate_noise().
///
/// @param singles   fits of single repeats, condition by condition; one alone tells nothing
/// @param healthy   fits of the averages of healthy conditions
/// @param averages  fits of all averages that are not their own reference
SignalErrors signal_errors(const std::vector<std::vector<SingleFit>>& singles,
                           const std::vector<const LeakFit*>& healthy,
                           const std::vector<const LeakFit*>& averages);

/// Sets what is beyond noise in all signals. Whether repeats differ at all is asked of all signals
/// together first, because what makes them differ acts on all; then of each signal. A test of few
/// degrees of freedom alone would call noise a difference in a quarter of all signals.
void separate_noise(const std::vector<SignalErrors*>& signals);

/// Share of the structured parity residual's power that a leak does not explain; 0 where no more is
/// left than noise, or twice of what healthy records leave.
///
/// @param healthy_m  structured rms that the healthy model leaves in healthy records
double unexplained_share(const LeakFit& fit, double healthy_m);

}  // namespace rigcal::diagnosis
