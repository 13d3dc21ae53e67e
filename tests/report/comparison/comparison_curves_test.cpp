#include "report/comparison/comparison_curves.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "report/page/page_overlay.hpp"
#include "report/store/csv.hpp"
#include "tests/report/stored_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Contains;
using namespace rigcal::report;

namespace {

/// A 1 Hz sine of `seconds` duration sampled at 100 Hz, and a model that is too high by `error`.
Table sine_series(double seconds, double error, double step_s = 0.01) {
  Table table;
  table.names = {"time_s", "measured_position_m", "simulated_position_m"};
  table.columns.resize(3);
  for (int i = 0; i * step_s < seconds; ++i) {
    const double t = i * step_s;
    const double y = std::sin(2.0 * M_PI * t);
    table.columns[0].push_back(t);
    table.columns[1].push_back(y);
    table.columns[2].push_back(y + error);
  }
  return table;
}

}  // namespace

TEST_CASE("overlaid: what was measured once, and the model of each result", "[report]") {
  const Table table = overlaid({{0, sine_series(5.0, 0.1)}, {2, sine_series(5.0, -0.2)}}, 1.0);
  CHECK(table.names == std::vector<std::string>{"time_s", "measured_position_m",
                                                "simulated_position_m_1",
                                                "simulated_position_m_3"});
  REQUIRE(table.columns.size() == 4);
  CHECK(table.columns[0].front() >= 2.98);  // the last two periods
  CHECK(table.columns[0].size() == 201);
  for (std::size_t i = 0; i < table.columns[0].size(); ++i) {
    CHECK(table.columns[2][i] == Approx(table.columns[1][i] + 0.1).margin(1e-12));
    CHECK(table.columns[3][i] == Approx(table.columns[1][i] - 0.2).margin(1e-12));
  }
}

TEST_CASE("overlaid: a long record keeps its peaks", "[report]") {
  Table series = sine_series(400.0, 0.0);
  series.columns[1][12345] = 7.0;
  const Table table = overlaid({{0, series}, {1, series}}, 0.0);
  CHECK(table.columns[0].size() <= 800);
  CHECK(std::count(table.columns[1].begin(), table.columns[1].end(), 7.0) == 1);
}

TEST_CASE("overlaid: other sample times are read between", "[report]") {
  const Table table =
      overlaid({{0, sine_series(1.0, 0.0)}, {1, sine_series(0.5, 0.0, 0.004)}}, 0.0);
  const auto& other = table.columns[3];
  CHECK(other[33] == Approx(std::sin(2.0 * M_PI * 0.33)).margin(1e-3));
  CHECK(std::isnan(other.back()));  // this record ended earlier
}

TEST_CASE("overlaid: its CSV is read back to the same bits", "[report]") {
  const Table table = overlaid({{0, sine_series(1.0, 0.1)}, {1, sine_series(0.5, 0.0)}}, 0.0);
  const Table back = parse_table(csv_of(table), "overlay.csv");
  CHECK(back.names == table.names);
  REQUIRE(back.columns.size() == table.columns.size());
  CHECK(back.columns[1] == table.columns[1]);
  CHECK(std::isnan(back.columns[3].back()));
}

TEST_CASE("comparison_curves: of conditions that two results have simulated", "[report]") {
  const rigcal::test::TemporaryFolder folder;
  std::vector<Compared> results;
  for (const char* name : {"a", "b"}) {
    const auto own = folder.path() / name;
    std::filesystem::create_directories(own / "residuals");
    std::ofstream(own / "residuals" / "sine.csv") << csv_of(sine_series(2.0, 0.1));
    results.push_back(compared_of(rigcal::test::stored_result(), own / "fit.json", name));
  }
  const auto files = comparison_curves(results);
  REQUIRE(files.size() == 1);
  CHECK(files[0].path == "overlay/sine.csv");
  CHECK_THAT(files[0].content, Contains("time_s,measured_position_m,simulated_position_m_1,"));
  SECTION("one was not simulated") {
    results[1].result.conditions[0].failure = "too many steps";
    CHECK(comparison_curves(results).empty());
  }
  SECTION("one has no residuals") {
    std::filesystem::remove(folder.path() / "b" / "residuals" / "sine.csv");
    CHECK(comparison_curves(results).empty());
  }
  SECTION("one has a name that leads elsewhere") {
    results[1].result.conditions[0].id = "../sine";
    CHECK_THROWS_WITH(comparison_curves(results), Contains("../sine") && Contains("fit.json"));
  }
  SECTION("one is no table") {
    std::ofstream(folder.path() / "b" / "residuals" / "sine.csv") << "time_s\nx\n";
    CHECK_THROWS_AS(comparison_curves(results), rigcal::InputError);
  }
}

TEST_CASE("overlay_figures: curves and residuals, a line for each result", "[report]") {
  const Table table = overlaid({{0, sine_series(1.0, 0.001)}, {1, sine_series(1.0, 0.002)}}, 0.0);
  const auto figures = overlay_figures("sine", table, {"before", "after"});
  REQUIRE(figures.size() == 2);
  CHECK(figures[0].name == "sine_position");
  REQUIRE(figures[0].plot.traces.size() == 3);
  CHECK(figures[0].plot.traces[0].name == "measured");
  CHECK(figures[1].name == "sine_position_residual");
  REQUIRE(figures[1].plot.traces.size() == 2);
  CHECK(figures[1].plot.y_label == "residual [mm]");
  CHECK(figures[1].plot.traces[1].y[5] == Approx(-2.0).margin(1e-9));
  CHECK(figures[1].plot.traces[0].style != figures[1].plot.traces[1].style);
  CHECK(overlay_figures("sine", Table{}, {"a", "b"}).empty());
}
