#pragma once

#include <string>
#include <vector>

#include "report/figure/svg.hpp"

namespace rigcal::report {

struct Point {
  double x = 0.0;  ///< NaN lifts the pen
  double y = 0.0;
};

/// A graphic element in pixels from the upper left corner of the picture.
struct Shape {
  enum class Kind { line, area, dots, cells, text };
  enum class Anchor { start, middle, end };
  Kind kind = Kind::line;
  std::string style;  ///< class in the style sheet
  std::vector<Point> points;
  std::string text;  ///< placed at the first point
  Anchor anchor = Anchor::start;
  double side = 0.0;  ///< side length of the square cells around the points
};

/// Returns the shapes of a plot from bottom to top: grid, ticks and labels, levels, traces, legend.
std::vector<Shape> plot_scene(const Plot& plot);

inline constexpr double kDotRadius = 2.2;
inline constexpr double kFontSize = 10.5;

}  // namespace rigcal::report
