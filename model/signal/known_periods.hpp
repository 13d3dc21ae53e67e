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

/// Continues a column of samples. Each further period is the last known one plus a multiple of its
/// change from the one before; every other one has the sign of `known`.
///
/// @param share  the multiples, shape (further periods); a period with zero ignores the change
void continue_periods(const KnownPeriods& known, std::span<const double> share,
                      std::span<double> column);

/// Adds to each further period of a column a multiple of the change in the last known period of
/// `values`; every other one has the sign of `known`.
///
/// @param share  the multiples, shape (further periods)
void add_changes(const KnownPeriods& known, std::span<const double> share,
                 std::span<const double> values, std::span<double> column);

}  // namespace rigcal::model
