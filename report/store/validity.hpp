#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib/score/validity.hpp"

namespace rigcal::report {

/// "5 mm", "0.1 to 10 Hz": both ends in the unit that suits the upper one.
///
/// @param unit  SI
std::string in_words(const Range& range, std::string_view unit);

/// Lists, in words and readable units, each way in which `asked` exceeds `covered`, the fitted
/// range, by more than 10 % of the bound.
///
/// @param validated  range of the validation, named in addition; null: none
std::vector<std::string> outside(const calib::Validity& asked, const calib::Validity& covered,
                                 const calib::Validity* validated = nullptr);

}  // namespace rigcal::report
