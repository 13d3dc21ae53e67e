#pragma once

#include <string>
#include <vector>

#include "report/document/document.hpp"
#include "report/text/style.hpp"

namespace rigcal::report::doc {

/// The verdict, then every section with its tables, facts, lists and sentences. Pictures stay on
/// the page, and so do closed folds but for their warnings. Where the style limits the lines, every
/// table is cut to as many rows as find room, and the rest is counted.
std::string render_terminal(const Verdict& verdict, const std::vector<Section>& sections,
                            const Style& style);

}  // namespace rigcal::report::doc
