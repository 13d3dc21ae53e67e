#pragma once

#include <string>

#include "report/figure/svg.hpp"

namespace rigcal::report {

/// Converts a picture to a PDF with a single page of the same size; a pixel is 0.75 points. Lines
/// remain vector graphics. Text is set in DejaVu Sans, with only the characters in use embedded.
/// The same plot always gives the same bytes.
///
/// @throws std::runtime_error  if memory runs out or the PDF library reports an error
std::string pdf(const Plot& plot);

}  // namespace rigcal::report
