#pragma once

#include <string>

namespace rigcal::report {

/// A TrueType file with the font of the figures, for libraries that read it by its name alone. The
/// font is built in; the file is one in memory, which ends with the process.
///
/// @throws std::runtime_error  there is no memory for it
const std::string& figure_font_file();

}  // namespace rigcal::report
