#pragma once

#include <optional>

#include "calib/fit.hpp"
#include "calib/published/leak_table.hpp"
#include "report/document/document.hpp"

// Words of every state that a result can be in. Each is a switch without a default: a state without
// words does not compile.

namespace rigcal::report::doc {

Badge badge(calib::Verdict verdict);
Badge badge(const std::optional<calib::Verdict>& verdict);
Badge badge(calib::AspectState state);
Badge badge(calib::Identifiability grade);
Badge badge(calib::LeakGrade grade);
Badge badge(datasets::LeakClass leak_class);
/// Of an estimate.
///
/// @param judged  the search came to its end
Badge badge(const std::optional<calib::Identifiability>& grade, bool at_bound, bool judged);

}  // namespace rigcal::report::doc
