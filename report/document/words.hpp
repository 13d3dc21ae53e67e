#pragma once

#include <optional>

#include "calib/fit.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "report/document/document.hpp"

// The words for every state of a result. Each function is a switch without a default case, so that
// the compiler rejects a state without words.

namespace rigcal::report::doc {

Badge badge(calib::Verdict verdict);
Badge badge(const std::optional<calib::Verdict>& verdict);
Badge badge(calib::AspectState state);
Badge badge(calib::Identifiability grade);
Badge badge(diagnosis::LeakGrade grade);
Badge badge(datasets::LeakClass leak_class);
/// Returns the badge for an estimate.
///
/// @param judged  whether the search converged
Badge badge(const std::optional<calib::Identifiability>& grade, bool at_bound, bool judged);

}  // namespace rigcal::report::doc
