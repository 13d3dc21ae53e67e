#include "report/figure/parity_plot.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using Catch::Contains;
using Catch::WithinAbs;
using rigcal::report::parity_plot;
using rigcal::report::Plot;
using rigcal::report::residual_moments;
using rigcal::report::svg;
using rigcal::report::Trace;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::size_t cells_of(const Plot& plot) {
  std::size_t cells = 0;
  for (const Trace& trace : plot.traces)
    if (trace.kind == Trace::Kind::cells) cells += trace.x.size();
  return cells;
}

}  // namespace

TEST_CASE("residual_moments: mean and standard deviation of what has both", "[report]") {
  const std::vector<double> measured{1.0, 2.0, kNan, 4.0};
  const std::vector<double> simulated{0.0, 3.0, 1.0, 1.0};
  const auto moments = residual_moments(measured, simulated);  // moments of 1, -1 and 3
  CHECK(moments.samples == 3);
  CHECK_THAT(moments.mean, WithinAbs(1.0, 1e-15));
  CHECK_THAT(moments.sd, WithinAbs(std::sqrt(8.0 / 3.0), 1e-15));
}

TEST_CASE("parity_plot: a long record takes no more room than a short one", "[report]") {
  std::vector<double> measured;
  std::vector<double> simulated;
  for (int i = 0; i < 200'000; ++i) {
    const double x = 0.05 * std::sin(1e-3 * i);
    measured.push_back(x);
    simulated.push_back(x + 1e-4 * ((i * 7919 % 101) / 101.0 - 0.5));
  }
  const Plot plot = parity_plot("x", measured, simulated, "mm", 1e-3);
  CHECK(cells_of(plot) > 70);  // the whole diagonal
  CHECK(cells_of(plot) < 400);
  CHECK(svg(plot).size() < 16'000);
}

TEST_CASE("parity_plot: a single sample far out is a cell of its own", "[report]") {
  std::vector<double> measured(1000, 0.0);
  std::vector<double> simulated(1000, 0.0);
  for (std::size_t i = 0; i < measured.size(); ++i)
    measured[i] = simulated[i] = 1e-3 * static_cast<double>(i % 10);
  const std::size_t without = cells_of(parity_plot("x", measured, simulated, "mm", 1e-3));
  simulated[500] = 8e-3;  // instead of 0
  const Plot plot = parity_plot("x", measured, simulated, "mm", 1e-3);
  CHECK(cells_of(plot) == without + 1);
  const auto sparse = std::find_if(plot.traces.begin(), plot.traces.end(),
                                   [](const Trace& trace) { return trace.style == "sparse"; });
  REQUIRE(sparse != plot.traces.end());
  REQUIRE(sparse->x.size() == 1);
  CHECK_THAT(sparse->x.front(), WithinAbs(0.0, 0.13));  // within one cell, in mm
  CHECK_THAT(sparse->y.front(), WithinAbs(8.0, 0.13));
}

TEST_CASE("parity_plot: limits of agreement stand where the residual lies", "[report]") {
  std::vector<double> measured;
  std::vector<double> simulated;
  for (int i = 0; i < 100; ++i) {
    measured.push_back(i);
    simulated.push_back(i + 2.0 + (i % 2 == 0 ? 1.0 : -1.0));  // 2 too high, plus or minus 1
  }
  const Plot plot = parity_plot("x", measured, simulated, "1", 1.0);
  std::vector<double> shifts;
  for (const Trace& trace : plot.traces)
    if (trace.style == "reference") shifts.push_back(trace.y.front() - trace.x.front());
  REQUIRE(shifts.size() == 2);
  CHECK_THAT(shifts[0], WithinAbs(2.0 - 1.96, 1e-12));
  CHECK_THAT(shifts[1], WithinAbs(2.0 + 1.96, 1e-12));
}

TEST_CASE("parity_plot: both axes have one range, so that equality is the diagonal", "[report]") {
  const std::vector<double> measured{0.0, 1.0, 2.0};
  const std::vector<double> simulated{0.0, 1.0, 10.0};
  const std::string text = svg(parity_plot("x", measured, simulated, "mm", 1.0));
  // From the lower left corner of the axes (64, 238) to the upper right corner, with a small
  // margin.
  CHECK_THAT(text, Contains("class=\"line measured\" d=\"M70.1 231.9L273.9 28.1\""));
  CHECK_THAT(text, Contains("class=\"cells "));
}

TEST_CASE("parity_plot: nothing to show is an empty plot", "[report]") {
  CHECK(parity_plot("x", {}, {}, "mm", 1.0).traces.empty());
  const std::vector<double> gaps{kNan, kNan};
  CHECK(parity_plot("x", gaps, gaps, "mm", 1.0).traces.empty());
}
