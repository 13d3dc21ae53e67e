#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "report/page/page_parts.hpp"

using namespace rigcal::report;
using Catch::WithinAbs;
using rigcal::diagnosis::RecordDiagnosis;

namespace {

RecordDiagnosis record_of(const std::string& signal, double share_percent) {
  RecordDiagnosis record;
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
  diagnosis.found.records = {record_of("sine 1 Hz", 3.0), record_of("square 1 Hz", 4.0),
                             record_of("sine 1 Hz", 5.0)};
  diagnosis.found.records.push_back(record_of("noise", 9.0));
  diagnosis.found.records.back().repeat = 1;  // a repeat is not in the figure
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

namespace {

/// A leak of 4, 5 and 6 % after 0, 10 and 20 days, with a rate of 0.05 to 0.2 % per day.
StoredDiagnosis growing_leak() {
  StoredDiagnosis diagnosis;
  double share = 4.0;
  for (const char* date : {"2026-01-01", "2026-01-11", "2026-01-21"}) {
    rigcal::diagnosis::MachineState& state = diagnosis.found.states.emplace_back();
    state.key.date = date;
    state.key.specimen = "A";
    state.leak.leak_share_percent = share;
    state.leak.leak_share_ci95_percent = {share - 0.2, share + 0.2};
    share += 1.0;
  }
  diagnosis.found.states.push_back(diagnosis.found.states.back());
  diagnosis.found.states.back().key.specimen = "another machine";
  diagnosis.found.states.back().leak.leak_share_percent = 50.0;
  rigcal::diagnosis::LeakTrend& trend = diagnosis.found.trends.emplace_back();
  trend.specimen = "A";
  trend.first_date = "2026-01-01";
  trend.last_date = "2026-01-21";
  trend.share_percent_per_day = 0.1;
  trend.share_percent_per_day_ci95 = {0.05, 0.2};
  trend.next_limit = {rigcal::datasets::LeakClass::medium, 10.0, "2026-03-02", "2026-02-10",
                      "2026-04-11"};
  return diagnosis;
}

/// Returns the trend's figure.
Plot trend_plot_of(const StoredDiagnosis& diagnosis) {
  const auto figures = diagnosis_figures(diagnosis);
  REQUIRE(figures.size() == 1);
  CHECK(figures[0].name.starts_with("diagnosis_trend"));
  return figures[0].plot;
}

}  // namespace

TEST_CASE("diagnosis_figures: a trend leads to the limit within the foreseen days", "[report]") {
  const Plot plot = trend_plot_of(growing_leak());
  CHECK(plot.levels == std::vector<double>{10.0});
  const Trace& found = trace_of(plot, Trace::Kind::points);
  CHECK(found.x == std::vector<double>{0.0, 10.0, 20.0});
  CHECK(found.y == std::vector<double>{4.0, 5.0, 6.0});
  // The line reaches the limit after 60 days; the edges of the band, after 40 and 100.
  const Trace& band = trace_of(plot, Trace::Kind::band);
  const Trace& line = trace_of(plot, Trace::Kind::line);
  const Trace& reached = plot.traces.back();
  const Trace& interval = plot.traces[plot.traces.size() - 2];
  CHECK(reached.x == std::vector<double>{60.0});
  CHECK(interval.x == std::vector<double>{40.0, 80.0});  // 80: four times the 20 days observed
  CHECK(band.x.back() == 80.0);
  CHECK_THAT(band.upper.back(), WithinAbs(6.0 + 0.2 * 60.0, 1e-12));
  CHECK_THAT(band.y.back(), WithinAbs(6.0 + 0.05 * 60.0, 1e-12));
  CHECK_THAT(band.upper.front(), WithinAbs(6.0 - 0.05 * 20.0, 1e-12));
  CHECK_THAT(line.y.back(), WithinAbs(12.0, 1e-12));
}

TEST_CASE("diagnosis_figures: a limit too far ahead is not drawn", "[report]") {
  StoredDiagnosis diagnosis = growing_leak();
  diagnosis.found.trends[0].next_limit->reached = "2026-03-23";  // after 81 days
  Plot plot = trend_plot_of(diagnosis);
  CHECK(plot.levels.empty());
  CHECK(trace_of(plot, Trace::Kind::line).x.back() == 20.0);
  diagnosis = growing_leak();
  diagnosis.found.trends[0].next_limit->latest.reset();  // may never be reached
  plot = trend_plot_of(diagnosis);
  CHECK(plot.traces[plot.traces.size() - 2].x == std::vector<double>{40.0, 80.0});
  diagnosis.found.states.clear();
  CHECK(diagnosis_figures(diagnosis).empty());
}
