#include "report/figure/plot_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/significant.hpp"

namespace rigcal::report {
namespace {

constexpr double kLeft = 64.0;
constexpr double kRight = 10.0;
constexpr double kTop = 22.0;
constexpr double kBottom = 36.0;
constexpr double kNextLine = 12.0;  ///< from one line of a name to the next

struct Axis {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  bool whole = false;  ///< only whole numbers: counts
  double start = 0.0;  ///< pixel position of `low`
  double length = 0.0;

  double scaled(double value) const { return logarithmic ? std::log10(value) : value; }
  double pixel(double value) const { return start + length * (scaled(value) - low) / (high - low); }
  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0.0); }
};

void widen(Axis& axis, const std::vector<double>& values, bool& any) {
  for (const double value : values) {
    if (!axis.shows(value)) continue;
    const double s = axis.scaled(value);
    axis.low = any ? std::min(axis.low, s) : s;
    axis.high = any ? std::max(axis.high, s) : s;
    any = true;
  }
}

void leave_room(Axis& axis, double share) {
  const double span = axis.high - axis.low;
  // On a logarithmic axis the value 1 maps to zero. There, a size of at least 1 ensures that a
  // series which differs only by rounding counts as constant.
  const double size =
      std::max({std::abs(axis.high), std::abs(axis.low), axis.logarithmic ? 1.0 : 0.0});
  // Even a constant needs an axis with some range.
  const double room = span > 1e-12 * size ? share * span : (size > 0.0 ? 0.1 * size : 1.0);
  axis.low -= room;
  axis.high += room;
}

constexpr int kTickDigits = 6;

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  return significant(value, kTickDigits);
}

struct Tick {
  double value;
  std::string text;
};

std::vector<Tick> ticks_of(const Axis& axis, int count) {
  std::vector<Tick> ticks;
  if (axis.whole) {
    const double step = std::max(1.0, std::ceil((axis.high - axis.low) / std::max(1, count)));
    for (double k = std::ceil(axis.low); k <= axis.high; k += step)
      ticks.push_back({k, significant(k, kTickDigits)});
    return ticks;
  }
  if (axis.logarithmic) {
    // If the axis spans less than two decades, it also needs ticks at twos and fives.
    const bool close = axis.high - axis.low < 2.0;
    for (double decades = std::max(1.0, std::ceil((axis.high - axis.low) / count)); decades >= 1.0;
         decades -= 1.0) {
      ticks.clear();
      for (double d = std::floor(axis.low); d <= axis.high; d += decades) {
        for (const double factor : {1.0, 2.0, 5.0}) {
          const double value = factor * std::pow(10.0, d);
          if (factor > 1.0 && !close) break;
          if (std::log10(value) >= axis.low && std::log10(value) <= axis.high)
            ticks.push_back({value, significant(value, kTickDigits)});
        }
      }
      if (ticks.size() > 1) return ticks;
    }
    // Over such a short interval a logarithmic axis is almost linear.
    ticks.clear();
    for (const double value :
         round_ticks(std::pow(10.0, axis.low), std::pow(10.0, axis.high), count))
      ticks.push_back({value, significant(value, kTickDigits)});
    return ticks;
  }
  const std::vector<double> values = round_ticks(axis.low, axis.high, count);
  const double step = values.size() > 1 ? values[1] - values[0] : 1.0;
  for (const double value : values) ticks.push_back({value, tick_text(value, step)});
  return ticks;
}

Point lifted() { return {std::nan(""), 0.0}; }

Shape line_shape(const std::string& style, std::vector<Point> points) {
  Shape shape;
  shape.style = style;
  shape.points = std::move(points);
  return shape;
}

Shape text_shape(const std::string& text, Point at, Shape::Anchor anchor,
                 const std::string& style = {}) {
  Shape shape;
  shape.kind = Shape::Kind::text;
  shape.style = style;
  shape.points = {at};
  shape.text = text;
  shape.anchor = anchor;
  return shape;
}

Shape line_trace(const Trace& trace, const Axis& x, const Axis& y) {
  Shape shape = line_shape(trace.style, {});
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    const bool shown = x.shows(trace.x[i]) && y.shows(trace.y[i]);
    shape.points.push_back(shown ? Point{x.pixel(trace.x[i]), y.pixel(trace.y[i])} : lifted());
  }
  return shape;
}

Shape band_trace(const Trace& trace, const Axis& x, const Axis& y) {
  Shape shape = line_shape(trace.style, {});
  shape.kind = Shape::Kind::area;
  const auto add = [&](std::size_t i, double value) {
    if (y.shows(trace.y[i]) && y.shows(trace.upper[i]))
      shape.points.push_back({x.pixel(trace.x[i]), y.pixel(value)});
  };
  for (std::size_t i = 0; i < trace.x.size(); ++i) add(i, trace.y[i]);
  for (std::size_t i = trace.x.size(); i-- > 0;) add(i, trace.upper[i]);
  return shape;
}

Shape point_trace(const Trace& trace, const Axis& x, const Axis& y) {
  Shape shape = line_shape(trace.style, {});
  shape.kind = Shape::Kind::dots;
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (x.shows(trace.x[i]) && y.shows(trace.y[i]))
      shape.points.push_back({x.pixel(trace.x[i]), y.pixel(trace.y[i])});
  }
  return shape;
}

Shape cell_trace(const Trace& trace, const Axis& x, const Axis& y) {
  Shape shape = point_trace(trace, x, y);
  shape.kind = Shape::Kind::cells;
  shape.side = x.pixel(trace.cell) - x.pixel(0.0);
  return shape;
}

Shape bar_trace(const Trace& trace, const Axis& x, const Axis& y) {
  Shape shape = line_shape(trace.style, {});
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i])) continue;
    const double at = x.pixel(trace.x[i]);
    shape.points.insert(shape.points.end(),
                        {{at, y.pixel(0.0)}, {at, y.pixel(trace.y[i])}, lifted()});
  }
  return shape;
}

Shape interval_trace(const Trace& trace, const Axis& x, const Axis& y) {
  constexpr double kCap = 3.0;
  Shape shape = line_shape(trace.style, {});
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i]) || !y.shows(trace.upper[i])) continue;
    const double at = x.pixel(trace.x[i]);
    const double low = y.pixel(trace.y[i]);
    const double high = y.pixel(trace.upper[i]);
    shape.points.insert(shape.points.end(), {{at - kCap, low},
                                             {at + kCap, low},
                                             lifted(),
                                             {at - kCap, high},
                                             {at + kCap, high},
                                             lifted(),
                                             {at, low},
                                             {at, high},
                                             lifted()});
  }
  return shape;
}

Shape trace_shape(const Trace& trace, const Axis& x, const Axis& y) {
  switch (trace.kind) {
    case Trace::Kind::points:
      return point_trace(trace, x, y);
    case Trace::Kind::bars:
      return bar_trace(trace, x, y);
    case Trace::Kind::band:
      return band_trace(trace, x, y);
    case Trace::Kind::intervals:
      return interval_trace(trace, x, y);
    case Trace::Kind::cells:
      return cell_trace(trace, x, y);
    case Trace::Kind::line:
      break;
  }
  return line_trace(trace, x, y);
}

/// Returns the first `letters` characters of a UTF-8 text, the last one replaced by an ellipsis if
/// the text is longer.
std::string cut(const std::string& text, std::size_t letters) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  if (static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins)) <= letters)
    return text;
  std::string result;
  std::size_t begun = 0;
  for (const char c : text) {
    if (begins(c) && ++begun == letters) break;
    result += c;
  }
  return result + "…";
}

/// Breaks a name at its last space within `letters` characters, and cuts what does not fit into two
/// lines.
std::vector<std::string> name_lines(const std::string& name, std::size_t letters) {
  if (name.size() <= letters) return {name};
  const std::size_t space = name.rfind(' ', letters);
  if (space == std::string::npos || space == 0) return {cut(name, letters)};
  return {name.substr(0, space), cut(name.substr(space + 1), letters)};
}

/// Writes each name below its category, with a line between categories.
void add_names(const Plot& plot, const Axis& x, double bottom, double top,
               std::vector<Shape>& shapes) {
  constexpr double kLetter = 5.6;  // mean width of a letter at this font size
  const double room = x.length / static_cast<double>(plot.x_names.size());
  const auto letters = static_cast<std::size_t>(std::max(2.0, room / kLetter - 1.0));
  double place = 0.0;
  for (const std::string& name : plot.x_names) {
    place += 1.0;
    if (place > 1.0) {
      const double edge = x.pixel(place - 0.5);
      shapes.push_back(line_shape("grid", {{edge, bottom}, {edge, top}}));
    }
    double at = bottom + 14.0;
    for (const std::string& line : name_lines(name, letters)) {
      shapes.push_back(text_shape(line, {x.pixel(place), at}, Shape::Anchor::middle));
      at += kNextLine;
    }
  }
}

void add_axes(const Plot& plot, const Axis& x, const Axis& y, std::vector<Shape>& shapes) {
  using Anchor = Shape::Anchor;
  const double bottom = y.start;
  const double top = y.start + y.length;
  const double right = x.start + x.length;
  if (plot.x_names.empty()) {
    for (const Tick& tick : ticks_of(x, static_cast<int>(x.length / (x.whole ? 20.0 : 70.0)))) {
      const double at = x.pixel(tick.value);
      shapes.push_back(line_shape("grid", {{at, bottom}, {at, top}}));
      shapes.push_back(text_shape(tick.text, {at, bottom + 14.0}, Anchor::middle));
    }
  } else {
    add_names(plot, x, bottom, top, shapes);
  }
  for (const Tick& tick : ticks_of(y, std::max(2, static_cast<int>(-y.length / 24.0)))) {
    const double at = y.pixel(tick.value);
    shapes.push_back(line_shape("grid", {{x.start, at}, {right, at}}));
    shapes.push_back(text_shape(tick.text, {x.start - 5.0, at + 3.5}, Anchor::end));
  }
  const double below = bottom + 29.0 + (plot.x_names.empty() ? 0.0 : kNextLine);
  shapes.push_back(text_shape(plot.x_label, {right, below}, Anchor::end));
  shapes.push_back(text_shape(plot.y_label, {2.0, 13.0}, Anchor::start, "axis"));
}

void add_legend(const Plot& plot, std::vector<Shape>& shapes) {
  constexpr double kLetter = 6.4;
  double at = plot.width - kRight;
  for (auto trace = plot.traces.rbegin(); trace != plot.traces.rend(); ++trace) {
    if (trace->name.empty()) continue;
    at -= kLetter * static_cast<double>(trace->name.size());
    shapes.push_back(text_shape(trace->name, {at, 13.0}, Shape::Anchor::start));
    const double left = at - 18.0;
    Shape key = line_shape(trace->style, {{left, 9.0}, {left + 14.0, 9.0}});
    if (trace->kind == Trace::Kind::points) {
      key.kind = Shape::Kind::dots;
      key.points = {{at - 9.0, 9.0}};
    } else if (trace->kind == Trace::Kind::band) {
      key.kind = Shape::Kind::area;
      key.points = {{left, 5.0}, {left + 14.0, 5.0}, {left + 14.0, 13.0}, {left, 13.0}};
    }
    shapes.push_back(std::move(key));
    at -= 32.0;
  }
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  std::vector<double> ticks;
  const double raw = (high - low) / std::max(1, count);
  // If ticks were closer than the floating-point resolution, the loop would never reach the end.
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  if (!(raw > kRounding * std::max(std::abs(low), std::abs(high))) || !std::isfinite(raw))
    return ticks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  // Picks the nearest of 1, 2, 5 and 10 on a logarithmic scale; the boundaries are geometric means.
  const double step = power * (raw <= std::sqrt(2.0) * power    ? 1.0
                               : raw <= std::sqrt(10.0) * power ? 2.0
                               : raw <= std::sqrt(50.0) * power ? 5.0
                                                                : 10.0);
  const double first = std::ceil(low / step - 1e-9);
  for (double k = first; k * step <= high + 1e-9 * step; k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::vector<Shape> plot_scene(const Plot& plot) {
  Axis x;
  Axis y;
  x.logarithmic = plot.log_x;
  y.logarithmic = plot.log_y;
  bool any_x = false;
  bool any_y = false;
  for (const Trace& trace : plot.traces) {
    widen(x, trace.x, any_x);
    widen(y, trace.y, any_y);
    widen(y, trace.upper, any_y);
    if (trace.kind == Trace::Kind::bars) widen(y, {0.0}, any_y);
  }
  widen(y, plot.levels, any_y);
  x.whole = plot.whole_x;
  if (plot.same_axes) {
    x.low = y.low = std::min(x.low, y.low);
    x.high = y.high = std::max(x.high, y.high);
    leave_room(x, 0.03);
    leave_room(y, 0.03);
  } else {
    if (!plot.x_names.empty()) {
      x.low = 0.5;
      x.high = static_cast<double>(plot.x_names.size()) + 0.5;
    } else if (x.whole) {
      x.low -= 0.5;
      x.high += 0.5;
    } else {
      leave_room(x, 0.0);
    }
    leave_room(y, 0.06);
  }
  x.start = plot.bare ? 0.0 : kLeft;
  x.length = plot.bare ? plot.width : plot.width - kLeft - kRight;
  const double bottom = kBottom + (plot.x_names.empty() ? 0.0 : kNextLine);
  y.start = plot.bare ? plot.height : plot.height - bottom;
  y.length = plot.bare ? -plot.height : kTop + bottom - plot.height;

  std::vector<Shape> shapes;
  if (!plot.bare) add_axes(plot, x, y, shapes);
  for (const double level : plot.levels) {
    if (!y.shows(level)) continue;
    const double at = y.pixel(level);
    shapes.push_back(line_shape("level", {{x.start, at}, {x.start + x.length, at}}));
  }
  for (const Trace& trace : plot.traces) shapes.push_back(trace_shape(trace, x, y));
  if (!plot.bare) add_legend(plot, shapes);
  return shapes;
}

}  // namespace rigcal::report
