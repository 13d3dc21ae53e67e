#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <string>

#include "report/figure/pdf.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Contains;
using rigcal::report::pdf;
using rigcal::report::Plot;
using rigcal::report::Trace;

namespace {

/// Returns the output of a program; empty if it is not installed or fails.
std::string printed_by(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part{};
  for (std::size_t count = 0; (count = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), count);
  return ::pclose(pipe) == 0 ? text : std::string();
}

Plot labelled_plot() {
  Plot plot;
  plot.x_label = "frequency [Hz]";
  plot.y_label = "phase [\xc2\xb0], \xc3\xbc";
  plot.traces = {{"record", "measured", Trace::Kind::line, {0.0, 10.0}, {-90.0, 0.0}, {}}};
  return plot;
}

}  // namespace

TEST_CASE("pdf: the map from codes to characters is one that readers take", "[report]") {
  const std::string document = pdf(labelled_plot());
  CHECK_THAT(document, Contains("1 beginbfrange\r\n<0000> <FFFF> <0000>\r\nendbfrange"));
  CHECK_THAT(document, !Contains("cidrange"));
}

TEST_CASE("pdf: its text can be searched and copied", "[report]") {
  if (printed_by("command -v pdftotext").empty()) {
    WARN("skipped: no pdftotext (scripts/setup --dev installs it)");
    return;
  }
  const rigcal::test::TemporaryFolder folder;
  const std::string file = (folder.path() / "figure.pdf").string();
  std::ofstream(file, std::ios::binary) << pdf(labelled_plot());
  const std::string text = printed_by("pdftotext -layout '" + file + "' - 2>&1");
  CHECK_THAT(text, Contains("frequency [Hz]") && Contains("phase [\xc2\xb0], \xc3\xbc") &&
                       Contains("record") && Contains("-80"));
  CHECK_THAT(text, !Contains("rror"));
}
