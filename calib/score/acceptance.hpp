#pragma once

#include <string>
#include <string_view>

#include "calib/result/condition_score.hpp"

namespace rigcal::calib {

/// Judges a score against the campaign's limits, and sets its checks, verdict and reasons. FAIL
/// means that a limit is broken, or that a metric with a limit does not exist. WARN means that a
/// value is between the limit and the warning limit. Under the guard band rule, WARN also means
/// that the margin to the limit does not exceed the score's expanded uncertainty, or that this
/// uncertainty is unknown. Channels that the condition did not record are not judged. A condition
/// whose channels have no limits gets no verdict. A condition that could not be simulated fails.
void judge(const std::vector<datasets::AcceptanceLimit>& limits, datasets::DecisionRule rule,
           ConditionScore& score);

/// Returns the name of a decision rule in certificates: "simple acceptance", "guard band".
std::string_view words_of(datasets::DecisionRule rule);

/// Formats the used fraction of a tolerance: "37 %", "99.96 %", "over 1000 %". If the limit is
/// kept, the fraction is never rounded to 100 %.
///
/// @param used  used fraction of the tolerance; above 1 the limit is broken
std::string tolerance_used_text(double used);

}  // namespace rigcal::calib
