#pragma once

#include <string>

#include "report/document/document.hpp"

namespace rigcal::report::doc {

/// Appends the HTML for a section to a page. All texts are escaped, and all pictures are SVG.
void render_html(const Section& section, std::string& page);
void render_html(const Blocks& blocks, std::string& page);
std::string html(const Line& line);

}  // namespace rigcal::report::doc
