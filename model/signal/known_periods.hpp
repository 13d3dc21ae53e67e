#pragma once

#include <cstddef>
#include <span>

namespace rigcal::model {

/// Samples of a periodic run of which all before `end` are known: the last period, `samples` long,
/// and the one before it where shares are not zero.
struct KnownPeriods {
  std::size_t end;
  std::size_t samples;
  double sign;  ///< -1 where each period is the one before it with the other sign, else 1
};

/// Continues a column of samples: each period to come is the last one that is known, and so many
/// times what that added to the one before it; every other one with the sign of `known`.
///
/// @param share  shape (periods to come); where it is zero the period before is not looked at
void continue_periods(const KnownPeriods& known, std::span<const double> share,
                      std::span<double> column);

/// Adds to each period to come of a column so many times what the last known period of `values`
/// added to the one before it; to every other one with the sign of `known`.
///
/// @param share  shape (periods to come)
void add_changes(const KnownPeriods& known, std::span<const double> share,
                 std::span<const double> values, std::span<double> column);

}  // namespace rigcal::model
