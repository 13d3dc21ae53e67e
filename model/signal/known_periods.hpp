#pragma once

#include <cstddef>
#include <span>

namespace rigcal::model {

/// The known samples of a periodic run are those before `end`. They include the last period, which
/// has `samples` samples, and also the period before it if a change is to be extrapolated.
struct KnownPeriods {
  std::size_t end;
  std::size_t samples;
  double sign;  ///< -1 if each period is its predecessor with the opposite sign, else 1
};

/// Extrapolates a column of samples. Each further period is the last known one plus a multiple of
/// its change since the previous one. Every other period is multiplied by the sign of `known`.
///
/// @param multiples  shape (further periods); if one is zero, the change is not read
void continue_periods(const KnownPeriods& known, std::span<const double> multiples,
                      std::span<double> column);

/// Adds a multiple of the change of `values` over the last known period to each further period of a
/// column. Every other period is multiplied by the sign of `known`.
///
/// @param multiples  shape (further periods)
void add_changes(const KnownPeriods& known, std::span<const double> multiples,
                 std::span<const double> values, std::span<double> column);

}  // namespace rigcal::model
