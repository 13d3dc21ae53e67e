#pragma once

#include <string>

namespace rigcal::report {

/// Returns the path of a TrueType file with the font for figures, for libraries that can only read
/// fonts from a file. The font is built in. The file exists only in memory and disappears with the
/// process.
///
/// @throws std::runtime_error  if no memory is available for it
const std::string& figure_font_file();

}  // namespace rigcal::report
