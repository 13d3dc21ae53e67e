#include "report/figure/svg.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "report/document/assets.hpp"

using Catch::Contains;
using rigcal::report::Plot;
using rigcal::report::round_ticks;
using rigcal::report::svg;
using rigcal::report::Trace;

TEST_CASE("svg: every text is escaped", "[report]") {
  Plot plot;
  plot.title = "<script>alert(1)</script>";
  plot.x_label = "a & b";
  plot.traces = {{"\"quoted\"", "model", Trace::Kind::line, {0.0, 1.0}, {0.0, 1.0}, {}}};
  const std::string text = svg(plot);
  CHECK_THAT(text, !Contains("<script"));
  CHECK_THAT(text, Contains("&lt;script&gt;"));
  CHECK_THAT(text, Contains("a &amp; b"));
  CHECK_THAT(text, Contains("&quot;quoted&quot;"));
}

TEST_CASE("svg: gaps break a line, constants and nothing at all are drawn", "[report]") {
  Plot plot;
  plot.traces = {{"", "model", Trace::Kind::line, {0, 1, 2, 3}, {1, std::nan(""), 1, 1}, {}}};
  const std::string text = svg(plot);
  const std::size_t path = text.find("class=\"line model\"");
  REQUIRE(path != std::string::npos);
  const std::string data = text.substr(path, text.find("/>", path) - path);
  CHECK(std::count(data.begin(), data.end(), 'M') == 2);
  CHECK_THAT(text, !Contains("nan"));
  CHECK_THAT(svg(Plot{}), Contains("</svg>") && !Contains("nan"));
}

TEST_CASE("svg: a logarithmic axis leaves out what has no logarithm", "[report]") {
  Plot plot;
  plot.log_x = plot.log_y = true;
  plot.traces = {{"", "model", Trace::Kind::points, {0.0, 1.0, 10.0}, {1.0, -1.0, 100.0}, {}}};
  const std::string text = svg(plot);
  CHECK_THAT(text, !Contains("nan") && !Contains("inf"));
  CHECK(text.find("<circle") == text.rfind("<circle"));
}

TEST_CASE("svg: ticks are round and within their range", "[report]") {
  CHECK(round_ticks(0.0, 10.0, 5) == std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0});
  CHECK(round_ticks(1.0, 1.0, 5).empty());
  // If the step were lost in rounding, the loop would never reach the end.
  const double next = std::nextafter(1.0, 2.0);
  CHECK(round_ticks(1.0, next, 5).empty());
  CHECK(round_ticks(-next, -1.0, 5).empty());
}

TEST_CASE("svg: what differs by rounding alone has an axis", "[report]") {
  for (const double value : {1.0, 1e-3, 7e8}) {
    CAPTURE(value);
    Plot plot;
    const std::vector<double> nearly{value, std::nextafter(value, 0.0)};
    plot.traces = {{"", "model", Trace::Kind::points, {1.0, 2.0}, nearly, {}}};
    for (const bool logarithmic : {true, false}) {
      plot.log_y = logarithmic;
      CHECK_THAT(svg(plot), Contains("<circle") && !Contains("nan"));
    }
  }
}

TEST_CASE("assets: page and library are built in", "[report]") {
  CHECK_THAT(std::string(rigcal::report::asset("uPlot.js")), Contains("uPlot"));
  CHECK_THROWS_AS(rigcal::report::asset("none"), std::out_of_range);
}

TEST_CASE("svg: categories have their names below them, cut where they do not fit", "[report]") {
  Plot plot;
  plot.width = 274.0;  // two categories with 100 pixels each
  plot.x_label = "signal";
  plot.x_names = {"sine 2 Hz", "random noise with a very long name"};
  plot.traces = {{"", "model", Trace::Kind::points, {1.0, 2.0}, {0.0, 0.5}, {}}};
  const std::string text = svg(plot);
  CHECK_THAT(text, Contains("x=\"114.0\"") && Contains(">sine 2 Hz</text>"));
  CHECK_THAT(text, Contains(">random noise</text>") && Contains(">with a very lon…</text>"));
  // Points are in the middle of their categories.
  CHECK_THAT(text, Contains("cx=\"114.0\"") && Contains("cx=\"214.0\""));
  CHECK_THAT(text, !Contains(">1</text>"));
  plot.x_names[1] = "süß-größer-schönste-Übung";  // no place to break, and letters of two bytes
  CHECK_THAT(svg(plot), Contains(">süß-größer-schö…</text>"));
}
