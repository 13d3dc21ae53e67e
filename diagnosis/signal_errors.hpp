#pragma once

#include <optional>
#include <vector>

#include "diagnosis/leak_fit.hpp"

namespace rigcal::diagnosis {

/// Errors of a leak that the records of one signal tell together, as an rms change of position, so
/// that they carry over from one leak level to another.
struct SignalErrors {
  /// Standard deviation of a single repeat about the mean of its condition, pooled.
  std::optional<double> repeat_m;
  int repeat_freedom = 0;
  /// Leak that healthy records seem to have, where they correct nothing: what the model lacks looks
  /// like a leak of this size.
  std::optional<double> healthy_m;
};

/// @param singles  fits of single repeats, condition by condition; one alone tells nothing
/// @param healthy  fits of the averages of healthy conditions
SignalErrors signal_errors(const std::vector<std::vector<const LeakFit*>>& singles,
                           const std::vector<const LeakFit*>& healthy);

/// Share of the structured parity residual's power that a leak does not explain; 0 where no more is
/// left than noise, or twice of what healthy records leave.
///
/// @param healthy_m  structured rms that the healthy model leaves in healthy records
double unexplained_share(const LeakFit& fit, double healthy_m);

}  // namespace rigcal::diagnosis
