#pragma once

#include <string>

#include "report/document/document.hpp"
#include "report/text/style.hpp"

namespace rigcal::report::doc {

/// Renders the verdict and the page to be signed. If the style shows everything, or the document
/// has no such page, all sections follow with their tables, facts, lists and sentences. Pictures
/// are not shown. Closed folds are reduced to their warnings unless the style shows everything.
/// If the style limits the number of lines, tables are shortened to fit, and the omitted rows are
/// counted.
std::string render_terminal(const Document& document, const Style& style);

}  // namespace rigcal::report::doc
