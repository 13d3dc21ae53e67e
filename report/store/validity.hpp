#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib/score/validity.hpp"

namespace rigcal::report {

/// Writes a range in words, with both ends in the unit that suits the upper end: "5 mm", "0.1 to
/// 10 Hz".
///
/// @param unit  SI unit of the range
std::string in_words(const Range& range, std::string_view unit);

/// Lists, in words and readable units, where `asked` exceeds the fitted range `covered` by more
/// than 10 % of the bound.
///
/// @param validated  range of the validation, which the words name as well; may be null
std::vector<std::string> outside(const calib::Validity& asked, const calib::Validity& covered,
                                 const calib::Validity* validated = nullptr);

}  // namespace rigcal::report
