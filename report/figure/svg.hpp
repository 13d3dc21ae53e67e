#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rigcal::report {

/// A trace of a picture, in the units of its axes.
struct Trace {
  enum class Kind { line, points, bars, band, intervals, cells };
  std::string name;   ///< in the legend; none if empty
  std::string style;  ///< class of the style sheet: "measured", "model", "residual", ...
  Kind kind = Kind::line;
  std::vector<double> x;
  std::vector<double> y;      ///< NaN: a gap
  std::vector<double> upper;  ///< for a band or intervals; `y` is the lower edge
  double cell = 0.0;          ///< for cells: side of the squares about the points
};

/// A trace that has no points yet.
inline Trace empty_trace(Trace::Kind kind, std::string style, std::string name = {}) {
  Trace trace;
  trace.kind = kind;
  trace.style = std::move(style);
  trace.name = std::move(name);
  return trace;
}

struct Plot {
  std::string title;  ///< first words for a screen reader
  std::string x_label;
  std::string y_label;
  double width = 720.0;
  double height = 200.0;
  bool log_x = false;
  bool log_y = false;
  bool bare = false;       ///< traces alone, from edge to edge: one of many small pictures
  bool whole_x = false;    ///< x counts: ticks at whole numbers, room beside the first and last
  bool same_axes = false;  ///< one range for both axes
  std::vector<Trace> traces;
  std::vector<double> levels;  ///< dashed horizontal lines, in units of y
};

/// A picture as SVG, coloured by the style sheet of the page. Every text is escaped.
///
/// @param style_sheet  included in a separate file; none if empty
std::string svg(const Plot& plot, const std::string& style_sheet = {});

/// Round numbers that divide [low, high] into about `count` parts.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace rigcal::report
