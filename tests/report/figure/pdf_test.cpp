#include "report/figure/pdf.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

using Catch::Contains;
using Catch::StartsWith;
using rigcal::report::pdf;
using rigcal::report::Plot;
using rigcal::report::Trace;

TEST_CASE("pdf: a plot of every kind is a document, the same bytes each time", "[report]") {
  Plot plot;
  plot.x_label = "Zeit \xc3\xbc \xe2\x86\x92";
  plot.y_label = "y";
  plot.levels = {0.5};
  const std::vector<double> x{0, 1, 2, 3};
  const std::vector<double> y{0.0, 1.0, std::nan(""), 0.5};
  for (const auto kind : {Trace::Kind::line, Trace::Kind::points, Trace::Kind::bars,
                          Trace::Kind::band, Trace::Kind::intervals})
    plot.traces.push_back({"trace", "model", kind, x, y, {1, 2, 2, 1}});
  const std::string text = pdf(plot);
  CHECK_THAT(text, StartsWith("%PDF-1."));
  CHECK(text.rfind("%%EOF") > text.size() - 10);
  CHECK(text.size() > 1000);
  CHECK(pdf(plot) == text);
  CHECK_THAT(text, Contains("/FontFile2"));  // the font is embedded
  CHECK_THAT(text, !Contains("Helvetica"));
  CHECK_THAT(pdf(Plot{}), StartsWith("%PDF-1."));
}
