#include "report/figure/svg.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "report/figure/plot_scene.hpp"
#include "report/text/escape.hpp"

namespace rigcal::report {
namespace {

/// Writes the same text as "{:.1f}", but fast enough for a path with ten thousand points. Values
/// that may be halfway between two tenths are left to fmt, which works with all digits.
void put_tenths(std::string& out, double value) {
  constexpr double kLargest = 1e9;
  constexpr double kNearHalf = 1e-3;
  const double tenths = 10.0 * std::abs(value);
  const double whole = tenths < kLargest ? std::floor(tenths) : tenths;
  const double rest = tenths - whole;
  if (!(tenths < kLargest) || std::abs(rest - 0.5) < kNearHalf) {
    out += fmt::format("{:.1f}", value);
    return;
  }
  const int rounded = static_cast<int>(whole) + (rest > 0.5 ? 1 : 0);
  if (std::signbit(value)) out += '-';
  std::array<char, 12> digits{};
  out.append(digits.data(),
             std::to_chars(digits.data(), digits.data() + digits.size(), rounded / 10).ptr);
  out += '.';
  out += static_cast<char>('0' + rounded % 10);
}

/// Coordinates are rounded to a tenth of a pixel, which is finer than any screen.
void put_path(std::string& out, const Shape& shape, const char* css, const char* end) {
  out += fmt::format("<path class=\"{}{}\" d=\"", css, shape.style);
  bool pen_down = false;
  for (const Point& point : shape.points) {
    if (std::isnan(point.x)) {
      pen_down = false;
      continue;
    }
    out += pen_down ? 'L' : 'M';
    put_tenths(out, point.x);
    out += ' ';
    put_tenths(out, point.y);
    pen_down = true;
  }
  out += end;
}

void put_cells(std::string& out, const Shape& shape) {
  out += fmt::format("<path class=\"cells {}\" d=\"", shape.style);
  for (const Point& point : shape.points) {
    out += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h-{:.1f}z", point.x - 0.5 * shape.side,
                       point.y - 0.5 * shape.side, shape.side, shape.side, shape.side);
  }
  out += "\"/>";
}

void put_text(std::string& out, const Shape& shape) {
  const char* anchor = shape.anchor == Shape::Anchor::middle ? " text-anchor=\"middle\""
                       : shape.anchor == Shape::Anchor::end  ? " text-anchor=\"end\""
                                                             : "";
  const std::string css =
      shape.style.empty() ? std::string() : fmt::format(" class=\"{}\"", shape.style);
  out += fmt::format("<text{} x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>", css, shape.points.front().x,
                     shape.points.front().y, anchor, escaped(shape.text));
}

}  // namespace

std::string svg(const Plot& plot, const std::string& style_sheet) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\" "
      "class=\"static\"><title>{2}</title>",
      plot.width, plot.height, escaped(plot.title));
  if (!style_sheet.empty()) out += "<style>" + style_sheet + "</style>";
  for (const Shape& shape : plot_scene(plot)) {
    switch (shape.kind) {
      case Shape::Kind::line:
        put_path(out, shape, "line ", "\"/>");
        break;
      case Shape::Kind::area:
        put_path(out, shape, "band ", "Z\"/>");
        break;
      case Shape::Kind::dots:
        for (const Point& point : shape.points) {
          out += fmt::format("<circle class=\"point {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>",
                             shape.style, point.x, point.y, kDotRadius);
        }
        break;
      case Shape::Kind::cells:
        put_cells(out, shape);
        break;
      case Shape::Kind::text:
        put_text(out, shape);
        break;
    }
  }
  return out + "</svg>";
}

}  // namespace rigcal::report
