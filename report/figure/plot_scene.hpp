#pragma once

#include <string>
#include <vector>

#include "report/figure/svg.hpp"

namespace rigcal::report {

struct Point {
  double x = 0.0;  ///< NaN: the pen is lifted
  double y = 0.0;
};

/// A piece of a picture, in its pixels from the upper left corner.
struct Shape {
  enum class Kind { line, area, dots, cells, text };
  enum class Anchor { start, middle, end };
  Kind kind = Kind::line;
  std::string style;  ///< class of the style sheet
  std::vector<Point> points;
  std::string text;  ///< at the first point
  Anchor anchor = Anchor::start;
  double side = 0.0;  ///< side of cells: squares about the points
};

/// The shapes of a plot from bottom to top: grid, ticks and labels, levels, traces, legend.
std::vector<Shape> plot_scene(const Plot& plot);

inline constexpr double kDotRadius = 2.2;
inline constexpr double kFontSize = 10.5;

}  // namespace rigcal::report
