#include "report/figure/figure_font.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>

// The bytes of the font, embedded by figure_font.S.
extern "C" const char rigcal_figure_font_begin[];
extern "C" const char rigcal_figure_font_end[];

namespace rigcal::report {
namespace {

std::string written_file() {
  const int file = ::memfd_create("rigcal-font", MFD_CLOEXEC);
  const char* at = rigcal_figure_font_begin;
  while (file >= 0 && at != rigcal_figure_font_end) {
    const ssize_t count = ::write(file, at, static_cast<std::size_t>(rigcal_figure_font_end - at));
    if (count <= 0) break;
    at += count;
  }
  if (at != rigcal_figure_font_end)
    throw std::runtime_error("the font of the figures cannot be kept in memory");
  return fmt::format("/proc/self/fd/{}", file);
}

}  // namespace

const std::string& figure_font_file() {
  static const std::string kFile = written_file();
  return kFile;
}

}  // namespace rigcal::report
