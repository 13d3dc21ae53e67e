#pragma once

#include <string>
#include <string_view>

#include "report/document/document.hpp"

namespace rigcal::report::doc {

/// Markup of sections and blocks, added to a page. Every text is escaped, every picture is SVG.
void render_html(const Section& section, std::string& page);
void render_html(const Blocks& blocks, std::string& page);
std::string html(const Line& line);

}  // namespace rigcal::report::doc
