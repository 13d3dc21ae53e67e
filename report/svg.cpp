#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "report/escape.hpp"

namespace rigcal::report {
namespace {

constexpr double kLeft = 64.0;
constexpr double kRight = 10.0;
constexpr double kTop = 22.0;
constexpr double kBottom = 36.0;

struct Axis {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  bool whole = false;  ///< counts
  double start = 0.0;  ///< pixel of `low`
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
  const double size = std::max(std::abs(axis.high), std::abs(axis.low));
  // A constant still needs an axis around it.
  const double room = span > 1e-12 * size ? share * span : (size > 0.0 ? 0.1 * size : 1.0);
  axis.low -= room;
  axis.high += room;
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  return fmt::format("{:.6g}", value);
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
      ticks.push_back({k, fmt::format("{:g}", k)});
    return ticks;
  }
  if (axis.logarithmic) {
    const double decades = std::max(1.0, std::ceil((axis.high - axis.low) / count));
    // Less than two decades need the twos and fives too.
    const bool close = axis.high - axis.low < 2.0;
    for (double d = std::floor(axis.low); d <= axis.high; d += decades) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, d);
        if (factor > 1.0 && !close) break;
        if (std::log10(value) >= axis.low && std::log10(value) <= axis.high)
          ticks.push_back({value, fmt::format("{:g}", value)});
      }
    }
    return ticks;
  }
  const std::vector<double> values = round_ticks(axis.low, axis.high, count);
  const double step = values.size() > 1 ? values[1] - values[0] : 1.0;
  for (const double value : values) ticks.push_back({value, tick_text(value, step)});
  return ticks;
}

/// Whole pixels and one decimal tell more than a screen shows.
void put(std::string& out, double pixel) {
  fmt::format_to(std::back_inserter(out), "{:.1f}", pixel);
}

void put_line(std::string& out, const Trace& trace, const Axis& x, const Axis& y) {
  fmt::format_to(std::back_inserter(out), "<path class=\"line {}\" d=\"", trace.style);
  bool pen_down = false;
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i])) {
      pen_down = false;
      continue;
    }
    out += pen_down ? 'L' : 'M';
    put(out, x.pixel(trace.x[i]));
    out += ' ';
    put(out, y.pixel(trace.y[i]));
    pen_down = true;
  }
  out += "\"/>";
}

void put_band(std::string& out, const Trace& trace, const Axis& x, const Axis& y) {
  std::string path;
  const auto add = [&](std::size_t i, double value) {
    if (!y.shows(trace.y[i]) || !y.shows(trace.upper[i])) return;
    path += path.empty() ? 'M' : 'L';
    put(path, x.pixel(trace.x[i]));
    path += ' ';
    put(path, y.pixel(value));
  };
  for (std::size_t i = 0; i < trace.x.size(); ++i) add(i, trace.y[i]);
  for (std::size_t i = trace.x.size(); i-- > 0;) add(i, trace.upper[i]);
  if (!path.empty()) out += "<path class=\"band " + trace.style + "\" d=\"" + path + "Z\"/>";
}

void put_points(std::string& out, const Trace& trace, const Axis& x, const Axis& y) {
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i])) continue;
    fmt::format_to(std::back_inserter(out),
                   "<circle class=\"point {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\"/>",
                   trace.style, x.pixel(trace.x[i]), y.pixel(trace.y[i]));
  }
}

void put_bars(std::string& out, const Trace& trace, const Axis& x, const Axis& y) {
  fmt::format_to(std::back_inserter(out), "<path class=\"line {}\" d=\"", trace.style);
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i])) continue;
    fmt::format_to(std::back_inserter(out), "M{:.1f} {:.1f}V{:.1f}", x.pixel(trace.x[i]),
                   y.pixel(0.0), y.pixel(trace.y[i]));
  }
  out += "\"/>";
}

void put_intervals(std::string& out, const Trace& trace, const Axis& x, const Axis& y) {
  constexpr double kCap = 3.0;
  fmt::format_to(std::back_inserter(out), "<path class=\"line {}\" d=\"", trace.style);
  for (std::size_t i = 0; i < trace.x.size(); ++i) {
    if (!x.shows(trace.x[i]) || !y.shows(trace.y[i]) || !y.shows(trace.upper[i])) continue;
    const double middle = x.pixel(trace.x[i]);
    const double low = y.pixel(trace.y[i]);
    const double high = y.pixel(trace.upper[i]);
    fmt::format_to(std::back_inserter(out), "M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}H{1:.1f}",
                   middle - kCap, middle + kCap, low, high);
    fmt::format_to(std::back_inserter(out), "M{:.1f} {:.1f}V{:.1f}", middle, low, high);
  }
  out += "\"/>";
}

void put_axes(std::string& out, const Plot& plot, const Axis& x, const Axis& y) {
  const double bottom = y.start;
  const double top = y.start + y.length;
  const auto into = std::back_inserter(out);
  for (const Tick& tick : ticks_of(x, static_cast<int>(x.length / (x.whole ? 20.0 : 70.0)))) {
    const double at = x.pixel(tick.value);
    fmt::format_to(into, "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>", at, bottom, top);
    fmt::format_to(into, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at,
                   bottom + 14.0, tick.text);
  }
  for (const Tick& tick : ticks_of(y, std::max(2, static_cast<int>(-y.length / 24.0)))) {
    const double at = y.pixel(tick.value);
    fmt::format_to(into, "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}H{2:.1f}\"/>", x.start, at,
                   x.start + x.length);
    fmt::format_to(into, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
                   x.start - 5.0, at + 3.5, tick.text);
  }
  fmt::format_to(into, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
                 x.start + x.length, bottom + 29.0, escaped(plot.x_label));
  fmt::format_to(into, "<text class=\"axis\" x=\"2\" y=\"13\">{}</text>", escaped(plot.y_label));
}

void put_legend(std::string& out, const Plot& plot) {
  double at = plot.width - kRight;
  for (auto trace = plot.traces.rbegin(); trace != plot.traces.rend(); ++trace) {
    if (trace->name.empty()) continue;
    at -= 6.4 * static_cast<double>(trace->name.size());
    const auto into = std::back_inserter(out);
    fmt::format_to(into, "<text x=\"{:.1f}\" y=\"13\">{}</text>", at, escaped(trace->name));
    switch (trace->kind) {
      case Trace::Kind::points:
        fmt::format_to(into, "<circle class=\"point {}\" cx=\"{:.1f}\" cy=\"9\" r=\"2.2\"/>",
                       trace->style, at - 9.0);
        break;
      case Trace::Kind::band:
        fmt::format_to(into, "<path class=\"band {}\" d=\"M{:.1f} 5h14v8h-14Z\"/>", trace->style,
                       at - 18.0);
        break;
      default:
        fmt::format_to(into, "<path class=\"line {}\" d=\"M{:.1f} 9h14\"/>", trace->style,
                       at - 18.0);
    }
    at -= 32.0;
  }
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  std::vector<double> ticks;
  const double raw = (high - low) / std::max(1, count);
  if (!(raw > 0.0) || !std::isfinite(raw)) return ticks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  // The nearest of 1, 2, 5 and 10 on a scale of ratios: bounds are the geometric means.
  const double step = power * (raw <= std::sqrt(2.0) * power    ? 1.0
                               : raw <= std::sqrt(10.0) * power ? 2.0
                               : raw <= std::sqrt(50.0) * power ? 5.0
                                                                : 10.0);
  const double first = std::ceil(low / step - 1e-9);
  for (double k = first; k * step <= high + 1e-9 * step; k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::string svg(const Plot& plot, const std::string& style_sheet) {
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
  if (x.whole) {
    x.low -= 0.5;
    x.high += 0.5;
  } else {
    leave_room(x, 0.0);
  }
  leave_room(y, 0.06);
  x.start = kLeft;
  x.length = plot.width - kLeft - kRight;
  y.start = plot.height - kBottom;
  y.length = kTop + kBottom - plot.height;

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\" "
      "class=\"static\"><title>{2}</title>",
      plot.width, plot.height, escaped(plot.title));
  if (!style_sheet.empty()) out += "<style>" + style_sheet + "</style>";
  put_axes(out, plot, x, y);
  for (const double level : plot.levels) {
    if (!y.shows(level)) continue;
    fmt::format_to(std::back_inserter(out), "<path class=\"level\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>",
                   x.start, y.pixel(level), x.start + x.length);
  }
  for (const Trace& trace : plot.traces) {
    switch (trace.kind) {
      case Trace::Kind::line:
        put_line(out, trace, x, y);
        break;
      case Trace::Kind::points:
        put_points(out, trace, x, y);
        break;
      case Trace::Kind::bars:
        put_bars(out, trace, x, y);
        break;
      case Trace::Kind::band:
        put_band(out, trace, x, y);
        break;
      case Trace::Kind::intervals:
        put_intervals(out, trace, x, y);
        break;
    }
  }
  put_legend(out, plot);
  out += "</svg>";
  return out;
}

}  // namespace rigcal::report
