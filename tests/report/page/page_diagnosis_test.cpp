#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "report/page/page_parts.hpp"

using namespace rigcal::report;
using Catch::WithinAbs;

namespace {

StoredDiagnosedRecord record_of(const std::string& signal, double share_percent) {
  StoredDiagnosedRecord record;
  record.condition = signal;
  record.signal = signal;
  record.leak.leak_share_percent = share_percent;
  record.leak.leak_share_ci95_percent = {share_percent - 1.0, share_percent + 1.0};
  return record;
}

const Trace& trace_of(const Plot& plot, Trace::Kind kind) {
  return *std::find_if(plot.traces.begin(), plot.traces.end(),
                       [&](const Trace& trace) { return trace.kind == kind; });
}

}  // namespace

TEST_CASE("diagnosis_figures: shares stand at their signals, not in the order of the records",
          "[report]") {
  StoredDiagnosis diagnosis;
  diagnosis.records = {record_of("sine 1 Hz", 3.0), record_of("square 1 Hz", 4.0),
                       record_of("sine 1 Hz", 5.0)};
  diagnosis.records.push_back(record_of("noise", 9.0));
  diagnosis.records.back().repeat = 1;  // a repeat is not in the figure
  const auto figures = diagnosis_figures(diagnosis);
  REQUIRE(figures.size() == 1);
  const Plot& plot = figures[0].plot;
  CHECK(plot.x_names == std::vector<std::string>{"sine 1 Hz", "square 1 Hz"});
  const Trace& found = trace_of(plot, Trace::Kind::points);
  CHECK(found.y == std::vector<double>{3.0, 5.0, 4.0});
  REQUIRE(found.x.size() == 3);
  // The two records of the sine lie beside each other about its place, 1.
  CHECK(found.x[0] < found.x[1]);
  CHECK_THAT(found.x[0] + found.x[1], WithinAbs(2.0, 1e-12));
  CHECK(found.x[1] < 1.5);
  CHECK_THAT(found.x[2], WithinAbs(2.0, 1e-12));
  CHECK(trace_of(plot, Trace::Kind::intervals).x == found.x);
}
