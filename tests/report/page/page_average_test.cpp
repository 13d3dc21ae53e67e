#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "report/page/page.hpp"
#include "report/page/page_parts.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using namespace rigcal::report;

namespace {

Json stored_average() {
  return Json::parse(R"({
    "schema": "rigcal.average/1", "campaign": "rig <b>", "synthetic": true,
    "records": [{"condition": "sine", "use": "fit", "samples": 4, "sample_rate_hz": 10.0,
      "duration_s": 0.3, "repeats": 3, "files": [], "channels": {
        "reference": {"unit": "m", "repeats": 3, "pooled_sd": null, "sd_of_mean": null,
          "noise_floor": null},
        "position": {"unit": "m", "repeats": 3, "pooled_sd": 2.5e-5, "sd_of_mean": 1.4e-5,
          "noise_floor": {"rho2": 0.998, "ccc": 0.999, "absolute_error_percent": 0.7}}},
      "offset_range_s": 0.0021, "repeat_reports": [
        {"source": "a.csv", "offset_s": -0.001, "deviation": 1.0, "outlier": false},
        {"source": "b.csv", "offset_s": 0.0011, "deviation": 1.1, "outlier": false},
        {"source": "c.csv", "offset_s": 0.0, "deviation": 9.0, "outlier": true}],
      "windows_s": [], "notes": ["every second sample"], "warnings": ["c.csv is an outlier"]}],
    "provenance": {"version": "0", "revision": "r", "machine": "m", "command": "rigcal average",
      "seed": 1, "options": {}, "inputs": []}})");
}

Json stored_plan() {
  return Json::parse(R"({
    "schema": "rigcal.plan/1", "campaign": "rig",
    "parameters": [
      {"name": "mass_kg", "unit": "kg", "scope": "rig", "level": null, "nuisance": false,
       "value": 80.0, "sd_recorded": 0.8, "sd_all": 0.4, "remedy": null},
      {"name": "bulk_modulus_pa", "unit": "Pa", "scope": "rig", "level": null, "nuisance": false,
       "value": 7e8, "sd_recorded": null, "sd_all": null, "remedy": "add a pressure"}],
    "records": [
      {"condition": "sine", "recorded": true, "problem": null, "sd_alone": [0.8, null],
       "sd_without": [0.5, null]},
      {"condition": "fast", "recorded": false, "problem": null, "sd_alone": [0.5, null],
       "sd_without": [0.8, null]}],
    "messages": [], "provenance": {"version": "0", "revision": "r", "machine": "m",
      "command": "rigcal plan", "seed": 1, "options": {}, "inputs": []}})");
}

std::string page_with(const std::string& file, const Json& json) {
  const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
    if (path == file) return json.dump();
    if (path == "averaged/sine.csv")
      return "time_s,position_m_mean,position_m_sd,position_m_count\n"
             "0,0,1e-5,3\n0.1,0.01,2e-5,3\n0.2,0.02,3e-5,3\n0.3,0.01,2e-5,3\n";
    return std::nullopt;
  };
  return result_page(rigcal::test::reading(read), "folder", 1);
}

}  // namespace

TEST_CASE("page: the repeats of every condition, their offsets and the noise floor", "[report]") {
  const std::string html = page_with("average.json", stored_average());
  CHECK_THAT(html, Contains("AVERAGED") && Contains("rig &lt;b&gt;") && !Contains("rig <b>"));
  CHECK_THAT(html, Contains("start up to 2.1 ms apart") && Contains("1 repeat flagged as outlier"));
  CHECK_THAT(html, Contains("value=\"2.5e-05\">25.0<") && Contains(">0.9980<"));
  CHECK_THAT(html, Contains("offset of each repeat of sine"));
  CHECK_THAT(html, Contains("position of sine, mean and standard deviation of its repeats"));
  CHECK_THAT(html, Contains("Warnings (1)") && Contains("sine: c.csv is an outlier"));
  // A command has no measurement error.
  CHECK_THAT(html, !Contains("data-label=\"Channel\">reference"));
}

TEST_CASE("average_figures: the band is the variation between repeats", "[report]") {
  const Table series = parse_table(
      "time_s,position_m_mean,position_m_sd,position_m_count\n0,0.01,1e-3,3\n0.1,0.02,2e-3,3\n",
      "sine.csv");
  const auto figures = average_figures("sine", series);
  REQUIRE(figures.size() == 2);
  const Trace& band = figures[0].plot.traces[0];
  CHECK(band.kind == Trace::Kind::band);
  CHECK(band.y[1] == Approx(18.0));  // in mm
  CHECK(band.upper[1] == Approx(22.0));
  CHECK(figures[1].plot.traces[0].y[1] == Approx(2.0));
  // A single repeat has no standard deviation.
  const Table single =
      parse_table("time_s,position_m_mean,position_m_sd,position_m_count\n0,0.01,,1\n0.1,0.02,,1\n",
                  "sine.csv");
  CHECK(average_figures("sine", single).size() == 1);
}

TEST_CASE("average_figures: no line joins the extremes of the variation between repeats",
          "[report]") {
  std::string text = "time_s,position_m_mean,position_m_sd,position_m_count\n";
  for (int i = 0; i < 4000; ++i)
    text += fmt::format("{},0.01,{},3\n", 0.01 * i, i % 7 == 0 ? 2e-5 : 1e-5);
  const auto figures = average_figures("sine", parse_table(text, "sine.csv"));
  REQUIRE(figures.size() == 2);
  const Trace& sd = figures[1].plot.traces[0];
  for (std::size_t i = 1; i < sd.x.size(); ++i) {
    if (std::isnan(sd.y[i - 1]) || std::isnan(sd.y[i])) continue;
    CHECK(sd.x[i - 1] == sd.x[i]);
  }
  CHECK(sd.x.front() >= 0.0);
  CHECK(sd.x.back() <= 39.99);
  CHECK(*std::max_element(sd.y.begin(), sd.y.end(), [](double a, double b) { return a < b; }) ==
        Approx(20.0));  // in µm
}

TEST_CASE("page: an average with a name that leads elsewhere is refused", "[report]") {
  Json json = stored_average();
  json["records"][0]["condition"] = "../sine";
  CHECK_THROWS_WITH(page_with("average.json", json),
                    Contains("average.json") && Contains("../sine"));
  json = stored_average();
  json.erase("records");
  CHECK_THROWS_AS(page_with("average.json", json), rigcal::InputError);
}

TEST_CASE("page: what each record tells of each parameter", "[report]") {
  const std::string html = page_with("plan.json", stored_plan());
  CHECK_THAT(html, Contains("1 of 2 records exist; all together determine 1 of 2 parameters."));
  CHECK_THAT(html, Contains("bulk_modulus_pa is not determined: add a pressure"));
  CHECK_THAT(html, Contains("2 fast (planned)") && Contains("From all records but one (2)"));
  const auto figures = plan_figures({as<StoredPlan>(stored_plan(), "folder", "plan.json"), {}});
  REQUIRE(figures.size() == 1);  // nothing is known about the other record
  REQUIRE(figures[0].plot.traces.size() == 2);
  CHECK(figures[0].plot.traces[0].upper[0] == Approx(25.0));  // (0.4 / 0.8)^2
  CHECK(figures[0].plot.traces[1].upper[0] == Approx(64.0));
  CHECK(figures[0].plot.traces[0].style != figures[0].plot.traces[1].style);
  // A record about which nothing is known gives no information on any parameter. An incomplete list
  // is an error.
  Json json = stored_plan();
  json["records"][1]["sd_alone"] = json["records"][1]["sd_without"] = Json::array();
  CHECK_THAT(page_with("plan.json", json), Contains("2 fast (planned)"));
  json["records"][1]["sd_alone"] = {0.5};
  CHECK_THROWS_WITH(page_with("plan.json", json),
                    Contains("plan.json") && Contains("found 1 entries, expected 2"));
}
