#include "report/page/page.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using Json = nlohmann::ordered_json;
using namespace rigcal::report;
using rigcal::test::stored_result;

namespace {

const std::string kNasty = "</script><script>alert(1)</script> \"q\" 'a' & \n\xc3\xbc";

std::string page(const Json& json, const std::string& file = "fit.json", int threads = 2) {
  const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
    if (path == file) return json.dump();
    if (path == "residual_tests.json") return rigcal::test::kNoCurves;
    if (path == "residuals/sine.csv") {
      return "time_s,measured_position_m,simulated_position_m,residual_position_m,sd_position_m,"
             "in_window,reference_m,servo_flow_m3_per_s,leakage_flow_m3_per_s\n"
             "0,0,0,0,,1,0,0,0\n0.1,0.001,0.0011,-0.0001,,1,0.001,1e-5,1e-6\n";
    }
    return std::nullopt;
  };
  return result_page(rigcal::test::reading(read), "folder", threads);
}

/// Returns the text inside the first element with this class.
std::string word_of(const std::string& html) {
  const std::size_t begin = html.find("<p class=\"word\">");
  return html.substr(begin, html.find("</p>", begin) - begin);
}

}  // namespace

/// Adds a reason to an aspect, and sets the state of the aspect.
void speak(Json& json, const char* aspect, const char* state, const char* code,
           const std::string& words) {
  Json& found = json["assessment"][aspect];
  found["state"] = state;
  found["reasons"].push_back({{"code", code},
                              {"state", state},
                              {"subject", nullptr},
                              {"numbers", Json::object()},
                              {"words", words}});
}

TEST_CASE("page: sections in the order of the guide", "[report]") {
  const std::string html = page(stored_result());
  std::size_t at = 0;
  for (const char* id : {"verdict", "assessment", "matrix", "parameters", "conditions",
                         "identifiability", "starts", "warnings", "provenance", "formulas"}) {
    const std::size_t found = html.find(std::string("<section id=\"") + id + "\"");
    CAPTURE(id);
    REQUIRE(found != std::string::npos);
    CHECK(found > at);
    at = found;
  }
  CHECK_THAT(html, Contains("href=\"#condition-sine\"") && Contains("id=\"condition-sine\""));
  // The plot library names its website in a comment, but nothing links outside the page.
  for (const char* outside : {"src=\"", "href=\"http", "@import", "url(http"})
    CHECK_THAT(html, !Contains(outside));
}

TEST_CASE("page: of many conditions the worst are shown in full", "[report]") {
  Json json = stored_result();
  const Json one = json["conditions"][0];
  const auto with = [&](int count) {
    json["conditions"] = Json::array();
    for (int i = 0; i < count; ++i) {
      Json condition = one;
      condition["id"] = fmt::format("c{}", i);
      condition["limit_checks"][0]["tolerance_used"] = i % 2 == 0 ? 0.5 + 1e-3 * i : 0.1;
      json["conditions"].push_back(condition);
    }
    json["conditions"][1]["verdict"] = json["conditions"][1]["limit_checks"][0]["verdict"] = "FAIL";
    json["conditions"][1]["channel_verdicts"]["position"] = "FAIL";
    json["conditions"][3]["failure"] = "the rig runs away";
    return page(json);
  };
  const auto is_full = [](const std::string& html, const std::string& id) {
    const bool full =
        html.find("<article class=\"condition\" id=\"condition-" + id + "\"") != std::string::npos;
    const bool sketched =
        html.find("<details class=\"sketch\" id=\"condition-" + id + "\"") != std::string::npos;
    CHECK(full != sketched);
    return full;
  };
  const std::string few = with(40);
  for (int i = 0; i < 40; ++i) CHECK(is_full(few, fmt::format("c{}", i)));
  const std::string many = with(101);
  // Shown in full: the condition that could not be simulated, the one that fails, and those that
  // use most of their limits.
  for (int i = 0; i < 101; ++i) {
    CAPTURE(i);
    CHECK(is_full(many, fmt::format("c{}", i)) == (i == 1 || i == 3 || (i % 2 == 0 && i >= 66)));
  }
  CHECK_THAT(
      many, Contains("The other 81 conditions") && Contains("1 FAIL") && Contains("the worst: c3"));
}

TEST_CASE("page: the plot library comes with its notice", "[report]") {
  const std::string html = page(stored_result());
  REQUIRE_THAT(html, Contains("var uPlot="));
  const std::size_t notice = html.find("Permission is hereby granted, free of charge");
  REQUIRE(notice != std::string::npos);
  CHECK(notice < html.find("var uPlot="));
  CHECK_THAT(html, Contains("Leon Sorokin") && Contains("WITHOUT WARRANTY OF ANY KIND"));
}

TEST_CASE("page: three numbers and every condition as a picture", "[report]") {
  Json json = stored_result();
  const std::string html = page(json);
  CHECK_THAT(html, Contains("<dt>Lowest rho2</dt><dd><strong>0.9988</strong> <span "
                            "class=\"soft\">position of sine, limit 0.9<"));
  CHECK_THAT(html, Contains("<dt>Largest mean error</dt><dd>") &&
                       Contains("<dt>Least certain estimate</dt><dd><strong>± "));
  const std::size_t matrix = html.find("<section id=\"matrix\"");
  const std::string cells = html.substr(matrix, html.find("</section>", matrix) - matrix);
  CHECK_THAT(cells, Contains("href=\"#condition-sine\""));
  CHECK_THAT(cells, Contains("class=\"line measured\"") && Contains("class=\"line model\""));
  CHECK_THAT(cells, Contains("position of sine, measured and model"));
  CHECK_THAT(cells, !Contains("class=\"line grid\""));  // a small picture has no axes
  // A condition that was not simulated has a cell without a picture.
  json["conditions"][0]["id"] = "lost";
  const std::string without = page(json);
  CHECK_THAT(without,
             Contains("href=\"#condition-lost\"") && !Contains("position of lost, measured"));
}

TEST_CASE("page: the three numbers are the worst of all channels and estimates", "[report]") {
  Json json = stored_result();
  Json& condition = json["conditions"][0];
  condition["metrics"]["load_pressure"] = condition["metrics"]["position"];
  condition["metrics"]["load_pressure"]["rho2"] = 0.9727;
  condition["metrics"]["load_pressure"]["absolute_error_percent"] = 3.11;
  condition["noise_floor"]["load_pressure"] = nullptr;
  condition["residual_tests"]["load_pressure"] = nullptr;
  Json force = json["parameters"][0];
  force["key"] = "external_force";
  force["name"] = "external_force_n";
  force["value"] = 10.0;
  force["ci95"] = {-4.0, 24.0};
  force["identifiability"] = "bounded";
  json["parameters"].push_back(force);
  CHECK_THAT(
      page(json),
      Contains("<strong>0.9727</strong> <span class=\"soft\">load pressure of sine, no limit<") &&
          Contains("<strong>3.11 % of the range</strong> <span class=\"soft\">load pressure") &&
          Contains("<strong>± 140 %</strong> <span class=\"soft\">external_force, not"));
  json["parameters"].back()["ci95"] = {-1e6, 1e6};
  CHECK_THAT(page(json),
             Contains("Least certain estimate</dt><dd><strong>not determined</strong>"));
  condition = json["conditions"][0];
  json["conditions"][0]["expanded_uncertainty"] = {{"position", nullptr}};
  json["conditions"][0]["expanded_uncertainty"]["load_pressure"] =
      json["conditions"][0]["metrics"]["load_pressure"];
  json["conditions"][0]["expanded_uncertainty"]["load_pressure"]["rho2"] = 0.00123;
  CHECK_THAT(page(json), Contains("load pressure of sine, no limit, U 0.0012<"));
  // A stopped search has neither uncertainties nor grades.
  json["status"] = "stopped";
  json["stopped_in"] = "starts";
  const std::string stopped = page(json);
  CHECK_THAT(stopped, !Contains("Least certain estimate") && Contains("not judged</span>") &&
                          !Contains("> identified<"));
}

TEST_CASE("page: the verdict calls no weak estimate determined, and no doubt comes twice",
          "[report]") {
  Json json = stored_result();
  json["verdict"] = "WARN";
  speak(json, "agreement", "reservation", "limit", "sine: rho2 is low");
  speak(json, "validation", "reservation", "limit", "sine: rho2 is low");
  Json weak = json["parameters"][0];
  weak["key"] = "damping";
  weak["name"] = "damping_n_s_per_m";
  weak["ci95"] = {20.0, 150.0};
  weak["identifiability"] = "weak";
  json["parameters"].push_back(weak);
  const std::string html = page(json);
  const std::string first = html.substr(0, html.find("<section id=\"assessment\""));
  CHECK_THAT(first, Contains("1 of 2 parameters is determined to ± 0.") &&
                        Contains("; 1 is not well determined."));
  const std::size_t doubt = first.find(">sine: rho2 is low<");
  REQUIRE(doubt != std::string::npos);
  CHECK(first.find(">sine: rho2 is low<", doubt + 1) == std::string::npos);
}

TEST_CASE("page: many doubts and values leave the first sheet fewer signals", "[report]") {
  Json json = stored_result();
  const Json condition = json["conditions"][0];
  json["conditions"] = Json::array();
  for (int i = 0; i < 10; ++i) {
    json["conditions"].push_back(condition);
    json["conditions"].back()["id"] = fmt::format("c{}", i);
  }
  CHECK_THAT(page(json), Contains("2 more signals</a>"));
  for (int i = 0; i < 6; ++i)
    speak(json, "parameters", "reservation", fmt::format("code_{}", i).c_str(),
          fmt::format("{} {}", i, std::string(300, 'x')));
  const Json parameter = json["parameters"][0];
  for (int i = 0; i < 11; ++i) json["parameters"].push_back(parameter);
  CHECK_THAT(page(json), Contains("7 more signals</a>"));
}

TEST_CASE("page: carries the exact numbers beside the readable ones", "[report]") {
  const std::string html = page(stored_result());
  CHECK_THAT(html, Contains("value=\"85.01139529\">85.01<"));
  CHECK_THAT(html, Contains("value=\"0.99876543\">0.9988<"));
  CHECK_THAT(html, Contains("value=\"6200000\">6.2<"));
  CHECK_THAT(html, Contains("0.1 to 10 Hz"));
}

TEST_CASE("page: whatever a file names is shown as text", "[report]") {
  Json json = stored_result();
  json["campaign"] = json["message"] = kNasty;
  json["conditions"][0]["leak_level"] = kNasty;
  json["conditions"][0]["reasons"] = {kNasty};
  json["warnings"] = {kNasty};
  json["provenance"]["command"] = kNasty;
  json["provenance"]["inputs"] = {{{"path", kNasty}, {"sha256", "0"}}};
  json["parameters"][0]["reason"] = kNasty;
  const std::string html = page(json);
  CHECK_THAT(html, !Contains("<script>alert"));
  CHECK_THAT(html, Contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
  CHECK_THAT(html, Contains("\xc3\xbc"));
}

TEST_CASE("page: opens with what the report is of, and who signs it", "[report]") {
  CHECK_THAT(page(stored_result()), !Contains("Report number") &&
                                        !Contains("class=\"signatures\"") &&
                                        Contains("Decision rule: simple acceptance"));
  Json json = stored_result();
  json["report"] = {{"number", "2026-041"},
                    {"laboratory", kNasty},
                    {"operator", "O. Perator"},
                    {"test_dates", {"2026-03-01", "2026-03-04"}},
                    {"sensors", {{{"channel", "position"}, {"certificate", "DKD 17"}}}}};
  const std::string html = page(json);
  CHECK_THAT(html, Contains("Report number <strong>2026-041</strong>") &&
                       Contains("<dt>Tested</dt><dd>2026-03-01 to 2026-03-04</dd>") &&
                       Contains("DKD 17") && Contains("Tested by O. Perator"));
  CHECK(html.find("2026-041") < html.find("class=\"verdict"));
  CHECK_THAT(html, !Contains("<script>alert"));
  json["acceptance"] = Json::array();
  CHECK_THAT(page(json), !Contains("Decision rule"));
  json["report"].erase("operator");
  CHECK_THAT(page(json), !Contains("class=\"signatures\""));
  json["report"]["approver"] = "A. Head";
  CHECK_THAT(page(json), Contains("class=\"signatures\"") && Contains("Approved by A. Head"));
}

TEST_CASE("page: a report that replaces another one says so", "[report]") {
  Json json = stored_result();
  json["report"] = {{"number", "2026-041"},
                    {"revision", "B"},
                    {"replaces", "2026-041, revision A"},
                    {"received", "2026-02-24"},
                    {"specimen_condition", "rod scored"},
                    {"deviations", "without preload"},
                    {"approver", "A. Head"},
                    {"approver_function", "head of laboratory"},
                    {"test_dates", nullptr},
                    {"sensors", Json::array()}};
  const std::string html = page(json);
  CHECK_THAT(html,
             Contains("<strong>2026-041, revision B</strong><br>replaces 2026-041, revision A"));
  // The foot of every sheet names the revision.
  CHECK_THAT(html.substr(html.find("@bottom-left"), 200), Contains("2026-041, revision B"));
  CHECK_THAT(html, Contains("<dt>Received</dt><dd>2026-02-24</dd>") && Contains("rod scored") &&
                       Contains("without preload") &&
                       Contains("Approved by A. Head, head of laboratory"));
}

TEST_CASE("page: says at its top what cannot be trusted", "[report]") {
  CHECK_THAT(word_of(page(stored_result())), Contains("PASS"));
  Json json = stored_result();
  SECTION("failed") {
    json["status"] = "failed";
    json["conditions"] = Json::array();
    json["verdict"] = nullptr;
    json["message"] = "no start could be simulated";
    const std::string html = page(json);
    CHECK_THAT(word_of(html), Contains("FAILED"));
    CHECK_THAT(html, Contains("<title>FAILED") && Contains("<body class=\"bad\">"));
    CHECK_THAT(html, Contains("no start could be simulated"));
  }
  SECTION("stopped") {
    json["status"] = "stopped";
    CHECK_THAT(word_of(page(json)), Contains("STOPPED"));
  }
  SECTION("stopped after the fit: its verdict counts") {
    json["status"] = "stopped";
    json["stopped_in"] = "bootstrap";
    json["message"] = "the bootstrap was stopped by the time limit";
    const std::string html = page(json);
    CHECK_THAT(word_of(html), Contains("STOPPED"));
    CHECK_THAT(html,
               Contains("The fit converged and was scored; further work that was requested") &&
                   Contains("the bootstrap was stopped by the time limit") &&
                   !Contains("not of a calibration"));
    json["verdict"] = "FAIL";
    CHECK_THAT(word_of(page(json)), Contains("FAIL"));
  }
  SECTION("stopped: neither scores nor intervals pass for those of a calibration") {
    json["status"] = "stopped";
    const std::string html = page(json);
    CHECK_THAT(html, Contains("not of a calibration") && Contains("are not valid here"));
    CHECK_THAT(page(stored_result()), !Contains("not of a calibration"));
  }
  SECTION("noise that nothing tells") {
    json["lack_of_fit"] = {{"misfit", nullptr}, {"tests", Json::array()}};
    json["lack_of_fit"]["tests"] = {{{"condition", "sine"},
                                     {"channel", "position"},
                                     {"against", "repeats"},
                                     {"ratio", 1.0},
                                     {"freedom", 2.0},
                                     {"pure_error_freedom", 8.0},
                                     {"p", 0.4},
                                     {"outcome", "not_judged"},
                                     {"reason", "few samples"}}};
    const std::string few = page(json);
    CHECK_THAT(few, Contains("Lack of fit cannot be judged: the records have too few"));
    CHECK_THAT(few, Contains("cannot be judged: few samples"));
    CHECK_THAT(few, !Contains("No lack of fit detected"));
    json["lack_of_fit"]["misfit"] = false;
    CHECK_THAT(page(json), Contains("No lack of fit detected."));
    json["lack_of_fit"]["misfit"] = true;
    CHECK_THAT(page(json), Contains("Significant lack of fit."));
  }
  SECTION("a residual that follows the input") {
    using rigcal::metrics::TestOutcome;
    rigcal::metrics::ResidualTests tests;
    const auto page_of = [&](TestOutcome outcome, const char* words) {
      tests.cross_correlation.emplace();
      tests.cross_correlation->outcome = outcome;
      tests.cross_correlation->verdict = words;
      json["conditions"][0]["residual_tests"]["position"] = json_of(tests);
      return page(json);
    };
    const std::string failed = page_of(TestOutcome::failed, "explained by the input");
    CHECK_THAT(failed, Contains("<span class=\"tag warn\" role=\"img\" aria-label=\"failed\">!"));
    const std::string open =
        page_of(TestOutcome::not_judged, "cannot be judged: effective sample size 3");
    CHECK_THAT(open, Contains("effective sample size 3"));
    CHECK_THAT(open, Contains("aria-label=\"cannot be judged\">○") && !Contains("tag good\">✓"));
    CHECK_THAT(page_of(TestOutcome::passed, "not correlated"),
               Contains("<span class=\"tag good\" role=\"img\" aria-label=\"passed\">✓"));
  }
  SECTION("outside the limits") {
    json["verdict"] = json["conditions"][0]["verdict"] = "FAIL";
    json["conditions"][0]["metrics"]["position"]["rho2"] = 0.5;
    json["conditions"][0]["reasons"] = {"position: rho2 = 0.5 is below 0.9"};
    json["conditions"][0]["channel_verdicts"]["position"] = "FAIL";
    speak(json, "agreement", "fail", "limit_broken", "sine: position: rho2 = 0.5 is below 0.9");
    const std::string html = page(json);
    CHECK_THAT(word_of(html), Contains("FAIL"));
    CHECK_THAT(html, Contains("sine: position: rho2 = 0.5 is below 0.9"));
    // What failed is validated for nothing.
    CHECK_THAT(html, Contains("Conditions tested: ") && !Contains("Validated for: "));
    CHECK_THAT(html, Contains("class=\"cell bad\""));
  }
  SECTION("poor, where the campaign has no limits") {
    json["verdict"] = json["conditions"][0]["verdict"] = nullptr;
    json["acceptance"] = Json::array();
    CHECK_THAT(word_of(page(json)), Contains("NOT JUDGED"));
    speak(json, "agreement", "not_assessed", "poor_agreement", "least agreement: rho2 = 0.5");
    const std::string html = page(json);
    CHECK_THAT(word_of(html), Contains("POOR"));
    CHECK_THAT(html, Contains("<body class=\"bad\">"));
  }
  SECTION("limits of its own in place of the campaign's") {
    json["conditions"][0]["metrics"]["position"]["rho2"] = 0.5;
    json["conditions"][0]["acceptance"] = {
        {{"channel", "position"}, {"metric", "rho2"}, {"limit", 0.4}, {"warn", nullptr}}};
    const std::string html = page(json);
    CHECK_THAT(html, !Contains("class=\"cell bad\""));
    CHECK_THAT(html, Contains("sine: limits of its own: rho2 0.4"));
  }
  SECTION("a condition that is not judged") {
    json["conditions"][0]["acceptance"] = Json::array();
    CHECK_THAT(page(json), Contains("sine: not judged"));
  }
  SECTION("a condition that could not be simulated") {
    json["verdict"] = json["conditions"][0]["verdict"] = "FAIL";
    json["conditions"][0]["failure"] = "too many steps";
    json["conditions"][0]["metrics"] = Json::object();
    CHECK_THAT(page(json), Contains("Could not be simulated: too many steps"));
  }
}

TEST_CASE("page: reservations stand apart from what speaks for a result", "[report]") {
  Json json = stored_result();
  json["verdict"] = "WARN";
  speak(json, "validation", "not_assessed", "no_validation", "none: every condition was fitted");
  speak(json, "adequacy", "reservation", "lack_of_fit", "lack of fit in 1 of 1 signals");
  for (int i = 0; i < 5; ++i)
    speak(json, "parameters", "reservation", "weak", "parameter " + std::to_string(i));
  const std::string html = page(json);
  CHECK_THAT(word_of(html), Contains("WARN"));
  CHECK_THAT(html, Contains("Passed with reservations (independent validation: not assessed, "
                            "adequacy of the model, parameters)."));
  CHECK_THAT(html, Contains("none: every condition was fitted</a>"));
  CHECK_THAT(html, Contains("<p>sine keeps its limits</p>"));
  CHECK_THAT(html, Contains("parameter 2") && Contains("and 2 more") && !Contains("parameter 3"));
}

TEST_CASE("page: a result of before there were assessments can still be drawn", "[report]") {
  Json json = stored_result();
  json.erase("assessment");
  json["conditions"][0].erase("channel_verdicts");
  const std::string html = page(json);
  CHECK_THAT(word_of(html), Contains("PASS"));
  CHECK_THAT(html, !Contains("<table class=\"aspects\">"));
}

TEST_CASE("page: says which parameter is not identified, and why", "[report]") {
  Json json = stored_result();
  json["parameters"][0]["identifiability"] = "not_identifiable";
  json["parameters"][0]["reason"] = "acts only together with damping";
  json["parameters"][0]["standard_error"] = nullptr;
  json["parameters"][0]["ci95"] = nullptr;
  const std::string html = page(json);
  CHECK_THAT(html, Contains("acts only together with damping"));
  CHECK_THAT(html, Contains("not identifiable"));
}

TEST_CASE("page: the same bytes for any number of threads", "[report]") {
  Json json = stored_result();
  for (int i = 0; i < 5; ++i) {
    json["conditions"].push_back(json["conditions"][0]);
    json["conditions"].back()["id"] = "sine" + std::to_string(i);
  }
  CHECK(page(json, "fit.json", 1) == page(json, "fit.json", 4));
}

TEST_CASE("page: what a fit holds beyond is drawn, what it lacks is left out", "[report]") {
  Json json = stored_result();
  const std::string without = page(json);
  for (const char* title :
       {"<h3>Profiles", "<h3>Bootstrap", "<h3>Lack of fit", "Cross-validation:"})
    CHECK_THAT(without, !Contains(title));
  json["parameters"][0]["profile"] = {{"low", {{"value", 84.9}, {"reached", 84.0}}},
                                      {"high", {{"value", nullptr}, {"reached", 500.0}}},
                                      {"values", {84.9, 85.0, 500.0}},
                                      {"rises", {1.0, 0.0, 0.4}}};
  json["combinations"] = {"only valve_gain / <mass> is fixed"};
  json["lack_of_fit"] = {{"misfit", true}, {"tests", Json::array()}};
  const std::string html = page(json);
  CHECK_THAT(
      html,
      Contains(
          "mass: lower end 84.9 kg, open at its upper end: still within the interval at 500 kg"));
  CHECK_THAT(html, Contains("How much can mass change?") && Contains("a curve through them"));
  CHECK_THAT(html, Contains("only valve_gain / &lt;mass&gt; is fixed"));
  CHECK_THAT(html, Contains("Significant lack of fit."));
  CHECK_THAT(html, !Contains("is missing or has no rows"));
  json["conditions"][0]["id"] = "lost";
  CHECK_THAT(page(json), Contains("residuals/lost.csv is missing or has no rows"));
}

TEST_CASE("page: long lists are folded, with their number", "[report]") {
  const auto opened = [](const std::string& html, const std::string& element) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = html.find(element, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const std::string open = "<details class=\"curves\" open>";
  const std::string closed = "<details class=\"curves\">";
  Json json = stored_result();
  CHECK(opened(page(json), open) == 1);
  const Json condition = json["conditions"][0];
  for (int i = 1; i < 9; ++i) {
    json["conditions"].push_back(condition);
    json["conditions"].back()["id"] = "sine";  // there is a series for this condition
    json["warnings"].push_back("doubtful");
  }
  CHECK_THAT(page(json), Contains("<details open>\n<summary>Warnings (8)</summary>"));
  json["warnings"].push_back("doubtful");
  const std::string html = page(json);
  CHECK(opened(html, open) == 1);  // only the first is open
  CHECK(opened(html, closed) == 8);
  CHECK_THAT(html, Contains("<details>\n<summary>Warnings (9)</summary>"));
  CHECK_THAT(html, Contains("Known values (1)"));
}

TEST_CASE("page: an estimate is told with its interval and grade on a narrow screen", "[report]") {
  const std::string html = page(stored_result());
  CHECK_THAT(html, Contains("<table class=\"parameters stack\">"));
  for (const char* label : {"Value", "95 % interval", "Identified?"})
    CHECK_THAT(html, Contains(std::string("data-label=\"") + label + "\""));
}

TEST_CASE("page: both uncertainties, the budget, the effects and the second estimate", "[report]") {
  Json json = stored_result();
  for (const char* word : {"U if the model is exact", "Uncertainty budget", "leaves out"})
    CHECK_THAT(page(json), !Contains(word));
  json["schema"] = "rigcal.fit/2";
  Json& mass = json["parameters"][0];
  mass["value"] = 85.0;
  mass["ci95"] = {75.0, 95.0};
  mass["ci95_if_exact"] = {84.5, 85.5};
  mass["budget"] = {{"lines",
                     {{{"source", "noise"}, {"kind", "records"}, {"uncertainty", 0.25}},
                      {{"source", "coulomb_friction"}, {"kind", "effect"}, {"uncertainty", 3.0}},
                      {{"source", "valve_time_constant"}, {"kind", "effect"}, {"uncertainty", 4.0}},
                      {{"source", "ki"}, {"kind", "effect"}, {"uncertainty", 0.01}}}},
                    {"combined", 5.00626},
                    {"degrees_of_freedom", 40.0},
                    {"coverage_factor", 2.02},
                    {"expanded", 10.1126},
                    {"shift", -0.5}};
  json["considered"] = {{"effects",
                         {{{"key", "valve_time_constant"},
                           {"meaning", "lag of the valve"},
                           {"unit", "s"},
                           {"size_from", "a corner <of> 300 Hz"},
                           {"size", 5e-4},
                           {"one_sided", true},
                           {"problem", nullptr},
                           {"estimate", 2e-4},
                           {"standard_error", 1e-5},
                           {"alone", 2.1e-4},
                           {"alone_half_width", 2e-5},
                           {"p_value", 1e-5},
                           {"p_of_all", 1.5e-4},
                           {"explains", 30.0}}}},
                        {"left_out", {"supply_sag"}},
                        {"missing", {"valve_time_constant"}}};
  json["stability"] = {{{"key", "mass"},
                        {"unit", "kg"},
                        {"scope", "rig"},
                        {"level", nullptr},
                        {"value", 97.0},
                        {"difference", 12.0},
                        {"expanded", 11.0},
                        {"differs", true}}};
  const std::string html = page(json);
  CHECK_THAT(html, Contains("U if the model is exact") && Contains("k = 2.02, coverage 95 %"));
  CHECK_THAT(html, Contains("Uncertainty budget") && Contains("all others") &&
                       Contains("Contributions one by one (4)"));
  CHECK_THAT(html, Contains("The residuals show valve_time_constant.") &&
                       Contains("a corner &lt;of&gt; 300 Hz") &&
                       Contains("Left out by the campaign: supply_sag."));
  CHECK_THAT(html, Contains("Estimates from the validation records alone") && Contains("differs"));
}

TEST_CASE("page: the budget of a score, and the U that it adds up to", "[report]") {
  Json json = stored_result();
  CHECK_THAT(page(json), !Contains("Uncertainty budgets of the scores"));
  Json& condition = json["conditions"][0];
  condition["expanded_uncertainty"]["position"] = condition["metrics"]["position"];
  condition["two_sided_uncertainty"]["position"] = condition["metrics"]["position"];
  condition["two_sided_uncertainty"]["position"]["rho2"] = 0.00125;
  condition["score_budgets"]["position"]["rho2"] = {
      {"lines",
       {{{"source", "repeats"}, {"kind", "records"}, {"uncertainty", 3e-4}},
        {{"source", "noise_left"}, {"kind", "records"}, {"uncertainty", 0.0}},
        {{"source", "position_gain"}, {"kind", "effect"}, {"uncertainty", 4e-4}}}},
      {"combined", 5e-4},
      {"degrees_of_freedom", 14.0},
      {"coverage_factor", 2.5},
      {"expanded", 0.00125},
      {"shift", 0.0}};
  const std::string html = page(json);
  const std::size_t begin = html.find("Uncertainty budgets of the scores");
  REQUIRE(begin != std::string::npos);
  const std::string budgets = html.substr(begin, html.find("</details>", begin) - begin);
  CHECK_THAT(budgets, Contains("rho2 of position") && Contains("value=\"0.00125\"") &&
                          Contains("noise left") && Contains("position gain") &&
                          !Contains("Shift"));
  // The table of scores shows the same U, not the one-sided uncertainty.
  CHECK_THAT(html.substr(0, begin), Contains("± <data value=\"0.00125\""));
}

TEST_CASE("page: the band of prediction lies around model and residual", "[report]") {
  const auto drawn = [](const std::string& titles, const std::string& fields) {
    const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
      if (path == "fit.json") return stored_result().dump();
      if (path == "residual_tests.json") return rigcal::test::kNoCurves;
      if (path != "residuals/sine.csv") return std::nullopt;
      std::string csv = "time_s,measured_position_m,simulated_position_m,residual_position_m" +
                        titles + ",in_window,reference_m\n";
      for (int i = 0; i < 100; ++i)
        csv += std::to_string(0.01 * i) + (i % 3 == 0 ? ",0.001" : ",0.0012") + ",0.0011,-0.0001" +
               fields + ",1,0.001\n";
      return csv;
    };
    return result_page(rigcal::test::reading(read), "folder", 1);
  };
  const std::string with = drawn(",prediction_sd_position_m", ",0.0002");
  CHECK_THAT(with, Contains("95 % prediction") && Contains("class=\"band model\""));
  CHECK_THAT(with, Contains(R"("factor":1.96)"));
  CHECK_THAT(with, Contains("of them are within the 95 % prediction band"));
  const std::string without = drawn("", "");
  CHECK_THAT(without, !Contains("95 % prediction"));
  CHECK_THAT(without, Contains(R"("prediction":null)"));
}

TEST_CASE("page: a result that cannot be read is named beside those that can", "[report]") {
  const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
    if (path == "fit.json") return stored_result().dump();
    if (path == "residual_tests.json") return rigcal::test::kNoCurves;
    if (path == "leak_table.json") return R"({"schema": "rigcal.leak_table/1"})";
    return std::nullopt;
  };
  const std::string html = result_page(rigcal::test::reading(read), "folder", 1);
  CHECK_THAT(word_of(html), Contains("PASS"));
  CHECK_THAT(html, Contains("Left out: folder") && !Contains("id=\"leak-table\""));
}

TEST_CASE("page: refuses what is no result of this version", "[report]") {
  using rigcal::InputError;
  CHECK_THROWS_AS(page(Json::array()), InputError);
  CHECK_THROWS_AS(page(Json::object()), InputError);
  CHECK_THROWS_WITH(page({{"schema", "other/1"}}),
                    Contains("fit.json") && Contains("other/1") && Contains("rigcal.fit/2"));
  CHECK_THROWS_WITH(page(stored_result(), "other.json"),
                    Contains("neither fit.json nor validation.json"));
  Json json = stored_result();
  json["conditions"][0].erase("metrics");
  CHECK_THROWS_WITH(page(json), Contains("folder") && Contains("metrics"));
}

TEST_CASE("page: 24 conditions stay below 8 MB, however long they are", "[report]") {
  // From about 6000 samples on, all records are thinned to the same number of points.
  constexpr int kSamples = 7000;
  Json json = stored_result();
  const Json condition = json["conditions"][0];
  json["conditions"] = Json::array();
  for (int i = 0; i < 24; ++i) {
    json["conditions"].push_back(condition);
    json["conditions"].back()["id"] = "c" + std::to_string(i);
  }
  std::string csv =
      "time_s,measured_position_m,simulated_position_m,residual_position_m,sd_position_m,in_window,"
      "reference_m,servo_flow_m3_per_s,leakage_flow_m3_per_s\n";
  for (int i = 0; i < kSamples; ++i) {
    const double x = 0.05 * std::sin(1e-3 * i) + 1e-5 * (i * 7919 % 101);
    csv += std::to_string(1e-3 * i);
    for (int k = 0; k < 4; ++k) csv += "," + std::to_string(x);
    csv += ",1";
    for (int k = 0; k < 3; ++k) csv += "," + std::to_string(x);
    csv += "\n";
  }
  const auto read = [&](const std::filesystem::path& path) -> std::optional<std::string> {
    if (path == "fit.json") return json.dump();
    if (path == "residual_tests.json") return rigcal::test::kNoCurves;
    if (path.parent_path() == "residuals") return csv;
    return std::nullopt;
  };
  const std::string html = result_page(rigcal::test::reading(read), "folder", 2);
  CHECK(html.size() < 8'000'000);
  CHECK(html.size() > 1'000'000);
}

TEST_CASE("page: page one is what is signed", "[report]") {
  Json json = stored_result();
  json["parameters"][0]["ci95"] = {84.96043529, 85.06235529};  // 1.96 standard errors on each side
  Json& condition = json["conditions"][0];
  condition["use"] = "validate";
  condition["expanded_uncertainty"]["position"] = condition["metrics"]["position"];
  condition["expanded_uncertainty"]["position"]["rho2"] = 0.00023;
  const std::string html = page(json);
  const std::string first = html.substr(0, html.find("<section id=\"assessment\""));
  CHECK_THAT(first,
             Contains("The model reproduces the test signal, <strong>1 of them (sine) not "
                      "used in the fit</strong>, with at most 1.2 % of the permitted error."));
  CHECK_THAT(first, Contains("expanded uncertainty U (k = 1.96, coverage 95 %)"));
  CHECK_THAT(first, Contains(">85.011<") && Contains("± <data value=\"0.05"));
  CHECK_THAT(first, Contains("<svg") && Contains("class=\"band allowed\""));
  CHECK_THAT(first,
             Contains("U <data value=\"0.00023\">0.00023</data>, limit <data value=\"0.9\">"));
  CHECK_THAT(first, Contains("<strong>held back</strong>") && Contains("1.2 % of the tolerance"));
  CHECK_THAT(first, Contains("Why this verdict") && Contains("SHA-256"));
  CHECK_THAT(first, !Contains("Before you sign"));
}

TEST_CASE("page: a score has its two-sided uncertainty wherever it is printed", "[report]") {
  Json json = stored_result();
  Json& condition = json["conditions"][0];
  for (const auto& [key, half] :
       {std::pair("expanded_uncertainty", 0.00077), std::pair("two_sided_uncertainty", 0.00033)}) {
    condition[key]["position"] = condition["metrics"]["position"];
    condition[key]["position"]["rho2"] = half;
  }
  const std::string html = page(json);
  CHECK_THAT(html, Contains("± <data value=\"0.00033\">") &&
                       Contains("U <data value=\"0.00033\">") && Contains("U 0.00033<"));
  CHECK_THAT(html, !Contains("value=\"0.00077\""));
  // A file from an earlier version has only the other.
  condition.erase("two_sided_uncertainty");
  CHECK_THAT(page(json), Contains("± <data value=\"0.00077\">"));
}

TEST_CASE("page: the posterior says how probable each leak class is", "[report]") {
  rigcal::calib::Posterior found;
  found.chains = 4;
  found.draws = 250;
  found.simulated = 200;
  found.message = "4 chains";
  Json json = stored_result();
  json["posterior"] = json_of(found);
  CHECK_THAT(page(json), !Contains("Probability of each leak class"));
  rigcal::calib::DrawnShare worn;
  worn.level = "worn seal";
  worn.condition = "sine";
  worn.draws = 200;
  worn.leak_share_percent = 9.25;
  worn.leak_share_ci95_percent = {7.5, 11.125};
  worn.class_probabilities = {{"normal", 0.0}, {"slight", 0.815}, {"medium", 0.185}};
  found.shares = {worn};
  json["posterior"] = json_of(found);
  CHECK_THAT(page(json), Contains("Probability of each leak class") && Contains("worn seal") &&
                             Contains(">9.25<") && Contains(">11.125<") && Contains("0.815") &&
                             Contains("0.185") && Contains("simulated for 200 draws"));
  // A file from an earlier version has no shares.
  json["posterior"].erase("shares");
  CHECK_THAT(page(json), !Contains("Probability of each leak class"));
}

TEST_CASE("page: an aspect says how many reasons it has for its own state", "[report]") {
  Json json = stored_result();
  json["verdict"] = "FAIL";
  speak(json, "adequacy", "reservation", "lack_of_fit", "lack of fit of a");
  speak(json, "agreement", "reservation", "recording_doubtful", "a spike");
  speak(json, "agreement", "fail", "limit_broken", "a breaks its limit");
  speak(json, "agreement", "fail", "limit_broken", "b breaks its limit");
  const std::string html = page(json);
  CHECK_THAT(html, Contains(">fails for 2 reasons<") && Contains(">1 reservation<"));
}

TEST_CASE("page: every kind of doubt is told before one signs", "[report]") {
  Json json = stored_result();
  json["verdict"] = "WARN";
  speak(json, "adequacy", "reservation", "lack_of_fit", "lack of fit of a");
  speak(json, "adequacy", "reservation", "lack_of_fit", "lack of fit of b");
  speak(json, "agreement", "fail", "limit_broken", "a breaks its limit");
  json["assessment"]["parameters"]["reasons"].push_back(
      {{"code", "exact_values"},
       {"state", "note"},
       {"subject", nullptr},
       {"numbers", Json::object()},
       {"words", "conditional on 2 known values"}});
  json["warnings"] = {"the record is short", "another"};
  const std::string html = page(json);
  const std::size_t begin = html.find("<div class=\"doubts\">");
  REQUIRE(begin != std::string::npos);
  const std::string doubts = html.substr(begin, html.find("</div>", begin) - begin);
  CHECK_THAT(doubts, Contains("Before you sign: 3 points."));
  CHECK(doubts.find("a breaks its limit") < doubts.find("lack of fit of a"));
  CHECK_THAT(doubts, Contains("(and 1 more of this kind)") && !Contains("lack of fit of b"));
  CHECK_THAT(doubts, Contains("2 warnings</a>: the record is short"));
  CHECK_THAT(doubts, !Contains("conditional on"));  // the note is below the table of values
  CHECK_THAT(html, Contains("Conditional on 2 known values."));
  // A warning that the table of parameters shows is in no list, and does not count.
  Json& parameter = json["parameters"].at(0);
  parameter["fitted"] = true;
  parameter["reason"] = "its interval is wide";
  json["warnings"].push_back("mass_kg: its interval is wide");
  CHECK_THAT(page(json), Contains("2 warnings</a>: the record is short"));
}

TEST_CASE("page: page one has eight signals, those held back and the worst first", "[report]") {
  Json json = stored_result();
  const Json condition = json["conditions"][0];
  json["conditions"] = Json::array();
  for (int i = 0; i < 11; ++i) {
    Json next = condition;
    next["id"] = "c" + std::to_string(i);
    next["limit_checks"][0]["tolerance_used"] = 0.01 * (i + 1);
    if (i == 3) next["use"] = "validate";
    json["conditions"].push_back(next);
  }
  const std::string html = page(json);
  const std::size_t begin = html.find("<table class=\"signals stack\">");
  REQUIRE(begin != std::string::npos);
  const std::string table = html.substr(begin, html.find("</table>", begin) - begin);
  CHECK(table.find(">c3<") < table.find(">c10<"));
  CHECK(table.find(">c10<") < table.find(">c9<"));
  CHECK_THAT(table, Contains(">c4<") && !Contains(">c2<"));
  CHECK_THAT(html, Contains("3 more signals</a>, all within their limits."));
}

TEST_CASE("page: a signal that fails is on page one, however many are held back", "[report]") {
  Json json = stored_result();
  Json condition = json["conditions"][0];
  condition["metrics"]["load_pressure"] = condition["metrics"]["position"];
  condition["metrics"]["load_pressure"]["rho2"] = 0.9512;
  json["conditions"] = Json::array();
  for (int i = 0; i < 12; ++i) {
    Json next = condition;
    next["id"] = "c" + std::to_string(i);
    next["use"] = i < 3 ? "fit" : "validate";
    next["limit_checks"][0]["tolerance_used"] = 0.01 * (i + 1);
    if (i == 1) {
      next["limit_checks"][0]["value"] = 0.5;
      next["limit_checks"][0]["tolerance_used"] = 5.0;
      next["limit_checks"][0]["verdict"] = "FAIL";
      next["verdict"] = next["channel_verdicts"]["position"] = "FAIL";
    }
    if (i == 7) next["metrics"]["load_pressure"]["rho2"] = 0.8431;
    json["conditions"].push_back(next);
  }
  json["verdict"] = "FAIL";
  const std::string html = page(json);
  const std::size_t begin = html.find("<table class=\"signals stack\">");
  REQUIRE(begin != std::string::npos);
  const std::string table = html.substr(begin, html.find("</table>", begin) - begin);
  REQUIRE(table.find(">c1<") != std::string::npos);
  CHECK(table.find(">c1<") < table.find(">c11<"));
  CHECK(table.find(">c11<") < table.find(">c10<"));
  CHECK_THAT(table, Contains(">c5<") && !Contains(">c4<") && !Contains(">c0<"));
  CHECK_THAT(html, Contains("4 more signals</a>, all within their limits."));
  // The channel without a limit has one line, with its lowest score.
  CHECK_THAT(table, !Contains("load pressure"));
  CHECK_THAT(html, Contains("Recorded but not judged, because no limit was agreed: load pressure "
                            "(lowest rho2 0.8431, c7)."));
}

TEST_CASE("page: what was fitted and what was validated are told apart", "[report]") {
  Json json = stored_result();
  json["schema"] = "rigcal.fit/2";
  json["validity"]["frequency_hz"] = {1.0, 2.0};
  json["validated"] = json["validity"];
  json["validated"]["frequency_hz"] = {3.0, 3.0};
  CHECK_THAT(page(json), Contains("frequency fitted 1 to 2 Hz, validated 3 Hz"));
  json["validated"]["frequency_hz"] = {1.0, 2.0};
  CHECK_THAT(page(json), Contains("frequency 1 to 2 Hz") && !Contains("fitted 1 to 2 Hz"));
  json["validity"]["frequency_hz"] = nullptr;
  CHECK_THAT(page(json), Contains("frequency validated 1 to 2 Hz"));
}

TEST_CASE("page: the foot of every sheet says whose report it is", "[report]") {
  Json json = stored_result();
  json["report"] = {{"number", "2026-041\"; } body { display: none } </style>"},
                    {"rig", "Bench 4"},
                    {"issued", "2026-03-02"},
                    {"test_dates", {"2026-02-26", "2026-02-27"}},
                    {"sensors",
                     {{{"channel", "position"}, {"instrument", "LVDT"}, {"due", "2026-02-27"}},
                      {{"channel", "load_pressure"}, {"due", "2025-01-31"}}}}};
  const std::string html = page(json);
  const std::string style = html.substr(html.find("@bottom-left"), 400);
  CHECK_THAT(style, Contains("2026-041\\22 \\3b  \\7d ") && Contains("\\3c \\2f style"));
  CHECK_THAT(style,
             Contains("Bench 4 · PASS · issued 2026-03-02 · relates only to the items tested"));
  CHECK_THAT(style, Contains("SHA-256 of fit.json ") && Contains("counter(page)"));
  // A sensor whose calibration was overdue on the last day of the test is red; one that is due on
  // that day is not.
  CHECK_THAT(
      html, Contains("<span class=\"tag bad\"><span aria-hidden=\"true\">✕</span> due 2025-01-31"));
  CHECK_THAT(html, Contains("LVDT, due 2026-02-27"));
}
