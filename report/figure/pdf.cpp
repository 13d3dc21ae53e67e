#include "report/figure/pdf.hpp"

#include <fmt/format.h>
#include <hpdf.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "report/figure/plot_scene.hpp"

// The bytes of the font, embedded by figure_font.S.
extern "C" const char rigcal_figure_font_begin[];
extern "C" const char rigcal_figure_font_end[];

namespace rigcal::report {
namespace {

constexpr double kPointsPerPixel = 0.75;
constexpr float kBandOpacity = 0.22F;

/// How lines and areas with a class from figure.css are drawn.
struct Ink {
  std::string_view style;
  unsigned rgb;
  double width;
  std::array<HPDF_UINT16, 2> dash;  ///< lengths of dash and gap in points; zero: solid
};
constexpr std::array kInks{
    Ink{"grid", 0xcccccc, 0.6, {}},     Ink{"level", 0x444444, 1.0, {3, 2}},
    Ink{"measured", 0x000000, 1.2, {}}, Ink{"model", 0xd55e00, 1.6, {}},
    Ink{"residual", 0x0072b2, 1.2, {}}, Ink{"reference", 0x777777, 1.2, {4, 2}},
    Ink{"servo", 0x009e73, 1.2, {}},    Ink{"leak", 0xb04a88, 1.6, {}},
    Ink{"axis", 0x000000, 1.2, {}},     Ink{"sparse", 0xa6cee3, 1.2, {}},
    Ink{"medium", 0x4a9bc9, 1.2, {}},   Ink{"dense", 0x00507f, 1.2, {}},
};
constexpr Ink kOther{"", 0x444444, 1.2, {}};

const Ink& ink_of(const std::string& style) {
  const auto found =
      std::find_if(kInks.begin(), kInks.end(), [&](const Ink& ink) { return ink.style == style; });
  return found == kInks.end() ? kOther : *found;
}

/// Writes the built-in font to a file in memory, which disappears with the process, because libharu
/// can only read fonts from a file. Returns its path.
std::string font_in_memory() {
  const int file = ::memfd_create("rigcal-font", MFD_CLOEXEC);
  const char* at = rigcal_figure_font_begin;
  while (file >= 0 && at != rigcal_figure_font_end) {
    const ssize_t count = ::write(file, at, static_cast<std::size_t>(rigcal_figure_font_end - at));
    if (count <= 0) break;
    at += count;
  }
  if (at != rigcal_figure_font_end)
    throw std::runtime_error("the font of the figures cannot be loaded into memory");
  return fmt::format("/proc/self/fd/{}", file);
}

/// Makes the text searchable, so that PDF readers can find and copy it. The character codes are
/// UTF-16. libharu (2.3) writes the map from codes to Unicode with the operators of a glyph map,
/// which PDF readers reject. The map is overwritten in place with one of the same length, because
/// the table at the end of the file refers to byte positions.
void make_searchable(std::string& document) {
  const std::size_t begin = document.find("1 beginnotdefrange");
  constexpr std::string_view kEnd = "endcidrange";
  const std::size_t end = document.find(kEnd, begin);
  std::string map = "1 beginbfrange\r\n<0000> <FFFF> <0000>\r\nendbfrange";
  if (begin == std::string::npos || end == std::string::npos ||
      end + kEnd.size() - begin < map.size())
    throw std::runtime_error("PDF: this version of libharu maps characters differently");
  map.resize(end + kEnd.size() - begin, ' ');
  document.replace(begin, map.size(), map);
}

/// A document with one page, which keeps the first error that the library reports.
class PdfPage {
 public:
  PdfPage(double width, double height) : height_(height) {
    if (!document_) throw std::runtime_error("PDF: out of memory");
    // Metadata are not compressed: they consist only of the CMap, which make_searchable() must
    // read.
    HPDF_SetCompressionMode(document_.get(), HPDF_COMP_TEXT | HPDF_COMP_IMAGE);
    page_ = HPDF_AddPage(document_.get());
    HPDF_Page_SetWidth(page_, real(width));
    HPDF_Page_SetHeight(page_, real(height));
    HPDF_UseUTFEncodings(document_.get());
    static const std::string kFont = font_in_memory();
    const char* name = HPDF_LoadTTFontFromFile(document_.get(), kFont.c_str(), HPDF_TRUE);
    if (name == nullptr)
      throw std::runtime_error(fmt::format("PDF: error {:#x} of libharu", error_));
    HPDF_Page_SetFontAndSize(page_, HPDF_GetFont(document_.get(), name, "UTF-8"), real(kFontSize));
  }

  void line(const Shape& shape, const Ink& ink) {
    set_ink(ink);
    bool pen_down = false;
    bool drawn = false;
    for (const Point& point : shape.points) {
      if (std::isnan(point.x)) {
        pen_down = false;
        continue;
      }
      if (pen_down) {
        HPDF_Page_LineTo(page_, real(point.x), up(point.y));
        drawn = true;
      } else {
        HPDF_Page_MoveTo(page_, real(point.x), up(point.y));
      }
      pen_down = true;
    }
    if (drawn) {
      HPDF_Page_Stroke(page_);
    } else if (pen_down) {
      HPDF_Page_EndPath(page_);
    }
  }

  void area(const Shape& shape, const Ink& ink) {
    if (shape.points.size() < 3) return;
    set_ink(ink);
    HPDF_Page_GSave(page_);
    HPDF_ExtGState see_through = HPDF_CreateExtGState(document_.get());
    HPDF_ExtGState_SetAlphaFill(see_through, kBandOpacity);
    HPDF_Page_SetExtGState(page_, see_through);
    HPDF_Page_MoveTo(page_, real(shape.points.front().x), up(shape.points.front().y));
    for (const Point& point : shape.points) HPDF_Page_LineTo(page_, real(point.x), up(point.y));
    HPDF_Page_ClosePath(page_);
    HPDF_Page_Fill(page_);
    HPDF_Page_GRestore(page_);
  }

  void dots(const Shape& shape, const Ink& ink) {
    set_ink(ink);
    for (const Point& point : shape.points) {
      HPDF_Page_Circle(page_, real(point.x), up(point.y), real(kDotRadius));
      HPDF_Page_Fill(page_);
    }
  }

  void cells(const Shape& shape, const Ink& ink) {
    if (shape.points.empty()) return;
    set_ink(ink);
    for (const Point& point : shape.points)
      HPDF_Page_Rectangle(page_, real(point.x - 0.5 * shape.side), up(point.y + 0.5 * shape.side),
                          real(shape.side), real(shape.side));
    HPDF_Page_Fill(page_);
  }

  void text(const Shape& shape, const Ink& ink) {
    set_ink(ink);
    const float width = HPDF_Page_TextWidth(page_, shape.text.c_str());
    const float shift = shape.anchor == Shape::Anchor::middle ? 0.5F * width
                        : shape.anchor == Shape::Anchor::end  ? width
                                                              : 0.0F;
    HPDF_Page_BeginText(page_);
    HPDF_Page_TextOut(page_, real(shape.points.front().x) - shift, up(shape.points.front().y),
                      shape.text.c_str());
    HPDF_Page_EndText(page_);
  }

  std::string bytes() {
    HPDF_SaveToStream(document_.get());
    std::string result(HPDF_GetStreamSize(document_.get()), '\0');
    auto size = static_cast<HPDF_UINT32>(result.size());
    HPDF_ReadFromStream(document_.get(), reinterpret_cast<HPDF_BYTE*>(result.data()), &size);
    result.resize(size);
    if (error_ != 0) throw std::runtime_error(fmt::format("PDF: error {:#x} of libharu", error_));
    return result;
  }

 private:
  static float real(double pixels) { return static_cast<float>(kPointsPerPixel * pixels); }
  float up(double y) const { return real(height_ - y); }

  void set_ink(const Ink& ink) {
    const auto part = [&](unsigned shift) {
      return static_cast<float>(ink.rgb >> shift & 255U) / 255.0F;
    };
    HPDF_Page_SetRGBStroke(page_, part(16), part(8), part(0));
    HPDF_Page_SetRGBFill(page_, part(16), part(8), part(0));
    HPDF_Page_SetLineWidth(page_, real(ink.width));
    HPDF_Page_SetDash(page_, ink.dash.data(), ink.dash[0] > 0 ? 2 : 0, 0);
  }

  static void note(HPDF_STATUS error, HPDF_STATUS /*detail*/, void* first) {
    auto& kept = *static_cast<HPDF_STATUS*>(first);
    if (kept == 0) kept = error;
  }

  struct Free {
    void operator()(HPDF_Doc document) const { HPDF_Free(document); }
  };

  double height_;
  HPDF_STATUS error_ = 0;
  std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, Free> document_{HPDF_New(&note, &error_)};
  HPDF_Page page_ = nullptr;
};

}  // namespace

std::string pdf(const Plot& plot) {
  PdfPage page(plot.width, plot.height);
  for (const Shape& shape : plot_scene(plot)) {
    const Ink& ink = ink_of(shape.style);
    switch (shape.kind) {
      case Shape::Kind::line:
        page.line(shape, ink);
        break;
      case Shape::Kind::area:
        page.area(shape, ink);
        break;
      case Shape::Kind::dots:
        page.dots(shape, ink);
        break;
      case Shape::Kind::cells:
        page.cells(shape, ink);
        break;
      case Shape::Kind::text:
        page.text(shape, ink);
        break;
    }
  }
  std::string document = page.bytes();
  make_searchable(document);
  return document;
}

}  // namespace rigcal::report
