#pragma once

#include <string>

#include "report/document/document.hpp"
#include "report/text/style.hpp"

namespace rigcal::report::doc {

/// The verdict and the page that is signed; every section with its tables, facts, lists and
/// sentences, where the style asks for everything or there is no such page. Pictures stay on the
/// page, and so do closed folds but for their warnings, unless the style asks for everything. Where
/// the style limits the lines, every table is cut to as many rows as find room, and the rest is
/// counted.
std::string render_terminal(const Document& document, const Style& style);

}  // namespace rigcal::report::doc
