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

TEST_CASE("response plots: conditions together, without a line from one to the next", "[report]") {
  ResponseCurves slow;
  slow.unit = "mm/V";
  slow.si_per_unit = 1e-3;
  slow.record = {response_point(1, 2e-3, -100, 1), response_point(3, 1e-3, 150, 1)};
  slow.model = {response_point(1, 2e-3, -90, 1), response_point(3, 1e-3, 160, 1)};
  ResponseCurves fast = slow;
  fast.si_per_unit = 1.0;  // the unit of the first is used
  fast.record = {response_point(2, 1.5e-3, -170, 1)};
  fast.model = {response_point(2, 1.4e-3, -175, 1)};
  const std::vector<ResponseCurves> all{slow, fast};
  const Plot gain = gain_plot("2 conditions", all);
  CHECK_THAT(gain.title, Catch::Contains("2 conditions"));
  const Trace& line = trace_of(gain, "model", Trace::Kind::line);
  REQUIRE(line.x.size() == 4);
  CHECK(std::isnan(line.x[2]));
  CHECK_THAT(line.y[3], WithinAbs(1.4, 1e-12));
  // 150 degrees at 3 Hz follow -170 at 2 Hz, although these belong to another condition.
  const Plot together = phase_plot("2 conditions", all);
  const Trace& phase = trace_of(together, "measured", Trace::Kind::points);
  CHECK(phase.y[0] == -100.0);
  CHECK(phase.y[1] == -210.0);
  CHECK(phase.y[3] == -170.0);
}
