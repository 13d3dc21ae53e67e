#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rigcal::report {

/// A trace in a picture, in the units of the axes.
struct Trace {
  enum class Kind { line, points, bars, band, intervals, cells };
  std::string name;   ///< shown in the legend; no entry if empty
  std::string style;  ///< class in the style sheet: "measured", "model", "residual", ...
  Kind kind = Kind::line;
  std::vector<double> x;
  std::vector<double> y;      ///< NaN leaves a gap
  std::vector<double> upper;  ///< upper edge of a band or of intervals; `y` is the lower edge
  double cell = 0.0;          ///< side length of the square cells around the points
};

inline Trace empty_trace(Trace::Kind kind, std::string style, std::string name = {}) {
  Trace trace;
  trace.kind = kind;
  trace.style = std::move(style);
  trace.name = std::move(name);
  return trace;
}

struct Plot {
  std::string title;  ///< first words for a screen reader
  std::string x_label{};
  std::string y_label{};
  double width = 720.0;
  double height = 200.0;
  bool log_x = false;
  bool log_y = false;
  bool bare = false;       ///< only the traces, from edge to edge, as one of many small pictures
  bool whole_x = false;    ///< x counts items: whole-number ticks, margins at the first and last
  bool same_axes = false;  ///< both axes have the same range
  std::vector<Trace> traces{};
  std::vector<double> levels{};  ///< dashed horizontal lines, in units of y
  /// Names of the categories on the x axis, which lie at x = 1, 2, ...; empty if x is a quantity. A
  /// name that is too long for two lines is cut.
  std::vector<std::string> x_names{};
};

/// Renders a picture as SVG. Colours come from the style sheet of the page. All text is escaped.
///
/// @param style_sheet  embedded for use as a separate file; omitted if empty
std::string svg(const Plot& plot, const std::string& style_sheet = {});

/// Returns round numbers that divide [low, high] into about `count` intervals.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace rigcal::report
