#pragma once

#include <string>

#include "report/svg.hpp"

namespace rigcal::report {

/// A picture as a PDF of one page, as large as the picture: a pixel is 0.75 points. Lines stay
/// lines; text is Helvetica, which every viewer has, and what Latin-1 does not hold is a question
/// mark. The same plot gives the same bytes.
///
/// @throws std::runtime_error  memory ran out in the PDF library
std::string pdf(const Plot& plot);

}  // namespace rigcal::report
