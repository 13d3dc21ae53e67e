#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "common/range.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::report {

/// "5 mm", "0.1 to 10 Hz": both ends in the unit that suits the upper one.
///
/// @param unit  SI
std::string in_words(const Range& range, std::string_view unit);

/// Ranges covered by the conditions of a fit; a range is empty if no condition gives it.
struct Validity {
  std::optional<Range> frequency_hz;
  std::optional<Range> amplitude;  ///< half of peak to peak of the drive: [m], or [V] in open loop
  std::string_view amplitude_unit = "m";
  std::optional<Range> supply_pressure_pa;
  std::optional<Range> leakage_coefficient;
  std::vector<std::string> leak_levels;
};

/// Ranges covered by the conditions of one use, with the values of `fit` if it has them.
///
/// @param records  those that were compared; they give the amplitude if a condition does not state
///                 it, and the supply if it was recorded
Validity coverage(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
                  const calib::Fit& fit, const std::vector<datasets::Use>& uses);

/// Lists, in words and readable units, each way in which `asked` exceeds `covered`, the fitted
/// range, by more than 10 % of the bound.
///
/// @param validated  range of the validation, named in addition; null: none
std::vector<std::string> outside(const Validity& asked, const Validity& covered,
                                 const Validity* validated = nullptr);

}  // namespace rigcal::report
