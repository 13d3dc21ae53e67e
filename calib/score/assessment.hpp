#pragma once

#include <optional>
#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"

namespace rigcal::calib {

/// Judges a finished fit or validation. No other function judges: reports only repeat its words.
/// The four aspects are judged separately, see judges.hpp.
///
/// @param estimated_from  ids of the conditions whose records the values were fitted to
/// @param parameters      how the validated fit judged its parameters; if null, they are judged
///                        from `fit`
Assessment assess(const datasets::Campaign& campaign, const Fit& fit,
                  const std::set<std::string>& estimated_from, const Aspect* parameters = nullptr);

/// Returns FAIL if agreement or validation fails, PASS if all four aspects pass, and WARN
/// otherwise. Absent if the campaign has no limits.
std::optional<Verdict> verdict_of(const Assessment& assessment);

/// Returns true if a report may state a range of validity, that is, if the result was validated
/// with separate records and no limit is broken. Otherwise the report states only which conditions
/// were tested.
bool has_range_of_validity(AspectState agreement, AspectState validation);

}  // namespace rigcal::calib
