#include "report/figure/response_plot.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace rigcal::report;
using Catch::WithinAbs;
using rigcal::metrics::ResponsePoint;

namespace {

ResponsePoint response_point(double frequency_hz, double gain, double phase_deg, double coherence) {
  ResponsePoint result;
  result.frequency_hz = frequency_hz;
  result.gain = gain;
  result.phase_deg = phase_deg;
  result.coherence = coherence;
  result.interval = {{0.9 * gain, 1.1 * gain, 5.0}};
  return result;
}

const Trace& trace_of(const Plot& plot, const std::string& style, Trace::Kind kind) {
  return *std::find_if(plot.traces.begin(), plot.traces.end(), [&](const Trace& trace) {
    return trace.style == style && trace.kind == kind;
  });
}

}  // namespace

TEST_CASE("coherent: only where record and model both follow the drive", "[report]") {
  ResponseCurves all;
  all.record = {response_point(1, 1, 0, 0.99), response_point(2, 1, 0, 0.3),
                response_point(3, 1, 0, 0.9), response_point(4, 1, 0, 0.9)};
  all.model = {response_point(1, 1, 0, 1.0), response_point(2, 1, 0, 1.0),
               response_point(4, 1, 0, 0.5)};
  const ResponseCurves kept = coherent(all);
  REQUIRE(kept.record.size() == 1);
  CHECK(kept.record[0].frequency_hz == 1.0);
  REQUIRE(kept.model.size() == 1);
  CHECK(kept.model[0].frequency_hz == 1.0);
}

TEST_CASE("gain_plot: in the unit of its axis, with intervals", "[report]") {
  ResponseCurves curves;
  curves.of = "position over command";
  curves.unit = "mm/V";
  curves.si_per_unit = 1e-3;
  curves.record = {response_point(1, 2e-3, -10, 1.0), response_point(10, 1e-3, -80, 0.9)};
  curves.record[1].interval.reset();
  curves.model = {response_point(1, 2.1e-3, -11, 1.0), response_point(10, 0.9e-3, -85, 1.0)};
  const Plot plot = gain_plot("sine", curves);
  CHECK(plot.log_x);
  CHECK(plot.log_y);
  CHECK(plot.y_label == "gain [mm/V]");
  CHECK_THAT(trace_of(plot, "measured", Trace::Kind::points).y[0], WithinAbs(2.0, 1e-12));
  CHECK_THAT(trace_of(plot, "model", Trace::Kind::line).y[1], WithinAbs(0.9, 1e-12));
  const Trace& spans = trace_of(plot, "measured", Trace::Kind::intervals);
  CHECK_THAT(spans.upper[0], WithinAbs(2.2, 1e-12));
  CHECK(std::isnan(spans.upper[1]));
}

TEST_CASE("phase_plot: runs on beyond half a turn, and the model with it", "[report]") {
  ResponseCurves curves;
  curves.record = {response_point(1, 1, -100, 1), response_point(2, 1, -170, 1),
                   response_point(3, 1, 150, 1), response_point(4, 1, 90, 1)};
  curves.model = {response_point(1, 1, -90, 1), response_point(2, 1, 175, 1),
                  response_point(3, 1, 160, 1), response_point(4, 1, 100, 1)};
  const Plot plot = phase_plot("sine", curves);
  CHECK(trace_of(plot, "measured", Trace::Kind::points).y ==
        std::vector<double>{-100, -170, -210, -270});
  CHECK(trace_of(plot, "model", Trace::Kind::line).y == std::vector<double>{-90, -185, -200, -260});
}
