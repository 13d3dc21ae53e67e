#include "report/figure/histogram_plot.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::report::histogram_plot;
using rigcal::report::Plot;
using rigcal::report::Trace;

namespace {

const Trace& trace_named(const Plot& plot, const std::string& name) {
  return *std::find_if(plot.traces.begin(), plot.traces.end(),
                       [&](const Trace& trace) { return trace.name == name; });
}

}  // namespace

TEST_CASE("histogram_plot: a density in the unit of its axis, over the normal one", "[report]") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(1e-3, 2e-3);  // in metres
  std::vector<double> residual;
  for (int i = 0; i < 20'000; ++i) residual.push_back(normal(random));
  residual.push_back(std::numeric_limits<double>::quiet_NaN());
  const Plot plot = histogram_plot("x", residual, "mm", 1e-3);
  const Trace& area = trace_named(plot, "residual");
  double mass = 0.0;
  for (std::size_t i = 0; i + 1 < area.x.size(); i += 2)
    mass += area.upper[i] * (area.x[i + 1] - area.x[i]);
  CHECK_THAT(mass, WithinAbs(1.0, 1e-12));
  const std::size_t bins = area.x.size() / 2;
  CHECK(bins >= 11);
  CHECK(bins <= 41);
  const Trace& curve = trace_named(plot, "normal");
  const auto peak = std::max_element(curve.y.begin(), curve.y.end());
  CHECK_THAT(*peak, WithinRel(1.0 / (2.0 * std::sqrt(2.0 * M_PI)), 0.02));  // in 1/mm
  const double at = curve.x[static_cast<std::size_t>(peak - curve.y.begin())];
  CHECK_THAT(at, WithinAbs(1.0, 0.2));  // in mm
  // The histogram of a normal residual follows the curve.
  CHECK_THAT(*std::max_element(area.upper.begin(), area.upper.end()), WithinRel(*peak, 0.15));
}

TEST_CASE("histogram_plot: a residual of two values stands out of the normal density", "[report]") {
  std::vector<double> residual;
  for (int i = 0; i < 1000; ++i) residual.push_back(i % 2 == 0 ? 1.0 : -1.0);
  const Plot plot = histogram_plot("x", residual, "1", 1.0);
  const Trace& area = trace_named(plot, "residual");
  const Trace& curve = trace_named(plot, "normal");
  CHECK(*std::max_element(area.upper.begin(), area.upper.end()) >
        5.0 * *std::max_element(curve.y.begin(), curve.y.end()));
}

TEST_CASE("histogram_plot: a constant residual has none", "[report]") {
  CHECK(histogram_plot("x", std::vector<double>(100, 2.0), "mm", 1e-3).traces.empty());
  CHECK(histogram_plot("x", {}, "mm", 1e-3).traces.empty());
}
