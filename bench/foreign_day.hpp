#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <string>

#include "bench/foreign_rig.hpp"
#include "datasets/stated_sizes.hpp"

namespace rigcal::bench {

/// Standard deviations between days.
struct DaySizes {
  double supply = 0.0;        ///< relative to the supply pressure
  double bulk_modulus = 0.0;  ///< relative to the bulk modulus
  double zero_m = 0.0;
  double trigger_s = 0.0;
};

/// The usual sizes for a ForeignRig (docs/diagnosis.md): its travel is 152.4 mm, and its records
/// have a sample each millisecond.
inline constexpr DaySizes kUsualDaySizes{5e-3, 0.03, 2e-4 * 0.1524, 0.5e-3};

DaySizes times(double factor, const DaySizes& sizes);

/// Returns a rig as it is on one day: supply, oil, zero and trigger have deviations of that day.
ForeignRig rig_of_day(ForeignRig rig, const DaySizes& sizes, boost::random::mt19937_64& stream);

/// Returns the sizes as a user would state them for a rig in `[between_days]`.
datasets::StatedSizes stated_days(const ForeignRig& rig, const DaySizes& sizes);

/// Returns a date in 2026; days are counted from January 1, in months of 28 days.
std::string date_of(int day);

}  // namespace rigcal::bench
