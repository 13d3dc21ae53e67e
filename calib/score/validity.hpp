#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/fit_result.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Ranges that the conditions of a fit cover. A range is absent if no condition provides a value.
struct Validity {
  std::optional<Range> frequency_hz;
  std::optional<Range> amplitude_m, amplitude_v;  ///< half the peak-to-peak value of the drive
  std::optional<Range> supply_pressure_pa;
  std::optional<Range> leakage_coefficient;
  std::vector<std::string> leak_levels;
  Omittable<Range> amplitude_n, amplitude_pa, amplitude_m_per_s2, amplitude_rad,
      amplitude_n_m;  ///< in other loops
  RIGCAL_DESCRIBE(frequency_hz, amplitude_m, amplitude_v, supply_pressure_pa, leakage_coefficient,
                  leak_levels, amplitude_n, amplitude_pa, amplitude_m_per_s2, amplitude_rad,
                  amplitude_n_m)

  struct Amplitude {
    std::optional<Range> range;
    std::string_view unit = "m";
  };
  Amplitude amplitude() const;
};

/// Stores an amplitude in the member for its unit: `amplitude_m`, `amplitude_v`, ...
template <typename Target, typename Value>
void put_amplitude(std::string_view unit, const std::optional<Value>& amplitude, Target& target) {
  if (unit == "m") target.amplitude_m = amplitude;
  if (unit == "V") target.amplitude_v = amplitude;
  if (!amplitude) return;
  if (unit == "N") target.amplitude_n = *amplitude;
  if (unit == "Pa") target.amplitude_pa = *amplitude;
  if (unit == "m/s2") target.amplitude_m_per_s2 = *amplitude;
  if (unit == "rad") target.amplitude_rad = *amplitude;
  if (unit == "N m") target.amplitude_n_m = *amplitude;
}

/// Computes the ranges covered by the conditions with the given uses. Values from `fit` take
/// precedence.
///
/// @param records  the compared records, which provide the amplitude if a condition does not state
///                 one, and the supply pressure if it was recorded
Validity coverage(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
                  const Fit& fit, const std::vector<datasets::Use>& uses);

}  // namespace rigcal::calib
