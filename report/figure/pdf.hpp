#pragma once

#include <string>

#include "report/figure/svg.hpp"

namespace rigcal::report {

/// A picture as a PDF of one page, as large as the picture: a pixel is 0.75 points. Lines stay
/// lines; text is DejaVu Sans, of which the letters in use are embedded. The same plot gives the
/// same bytes.
///
/// @throws std::runtime_error  memory ran out, or the PDF library met an error
std::string pdf(const Plot& plot);

}  // namespace rigcal::report
