#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/batch/batch.hpp"
#include "report/document/render_terminal.hpp"
#include "report/page/page_parts.hpp"
#include "report/page/section.hpp"
#include "tests/report/stored_fixture.hpp"

// Tests for the row of a rig and the summary of all rows.

using Catch::Contains;
using namespace rigcal::report;
using rigcal::ExitCode;
using rigcal::calib::FitStatus;
using rigcal::calib::Verdict;
using rigcal::test::stored_result;

namespace {

RigRun run_of(const Json& result) {
  RigRun run;
  run.rig = "lab/bench_2";
  run.campaign = "lab/bench_2/campaign.toml";
  run.folder = "lab/bench_2";
  run.code = ExitCode::done;
  run.seconds = 1.25;
  run.result = compared_of(result, "out/lab/bench_2/fit.json", "now");
  return run;
}

Json condition_of(const std::string& id, double rho2, const char* verdict) {
  Json condition = stored_result()["conditions"][0];
  condition["id"] = id;
  condition["metrics"]["position"]["rho2"] = rho2;
  condition["channel_verdicts"]["position"] = verdict;
  condition["verdict"] = verdict;
  return condition;
}

std::vector<std::string> worst(const StoredRig& row) {
  std::vector<std::string> list;
  for (const StoredRigScore& each : row.worst_scores) list.push_back(each.condition);
  return list;
}

StoredRig rig_of(const std::string& name, std::optional<FitStatus> status,
                 std::optional<Verdict> verdict, int exit_code) {
  StoredRig rig;
  rig.rig = name;
  rig.status = status;
  rig.verdict = verdict;
  rig.exit_code = exit_code;
  rig.message = "message of " + name;
  return rig;
}

StoredRigTrend trend_of(const std::string& of, double slope, bool significant) {
  StoredRigTrend trend;
  trend.key = "leakage_coefficient";
  trend.unit = "1";
  trend.series.of = of;
  trend.series.along_date.slope = slope;
  trend.series.along_date.ci95 = rigcal::Range{0.5 * slope, 1.5 * slope};
  trend.series.along_date.significant = significant;
  return trend;
}

/// Returns the cells in a line of CSV text. The cells must not contain commas.
std::vector<std::string> cells(const std::string& text, std::size_t line) {
  std::size_t begin = 0;
  for (; line > 0; --line) begin = text.find('\n', begin) + 1;
  std::vector<std::string> list(1);
  for (std::size_t i = begin; i < text.size() && text[i] != '\n'; ++i) {
    if (text[i] == ',')
      list.emplace_back();
    else if (text[i] != '\r')
      list.back() += text[i];
  }
  return list;
}

std::string cell(const std::string& text, std::size_t line, const std::string& column) {
  const auto head = cells(text, 0);
  for (std::size_t i = 0; i < head.size(); ++i)
    if (head[i] == column) return cells(text, line).at(i);
  return "no column " + column;
}

}  // namespace

TEST_CASE("batch row: where the rig is, and how its run ended", "[report]") {
  RigRun run = run_of(stored_result());
  run.unchanged = true;
  run.unread = {"an earlier result is left out"};
  StoredRig row = rig_row(run);
  CHECK(row.rig == "lab/bench_2");
  CHECK(row.campaign == "lab/bench_2/campaign.toml");
  CHECK(row.folder == "lab/bench_2");
  CHECK(row.name == "rig");
  CHECK(row.exit_code == 0);
  CHECK(row.unchanged);
  CHECK(row.seconds == 1.25);
  CHECK(row.status == FitStatus::converged);
  CHECK(row.verdict == Verdict::pass);
  CHECK(row.message == "converged");
  CHECK(row.has_report);
  CHECK(row.warnings == std::vector<std::string>{"an earlier result is left out"});
  CHECK(row.reasons.empty());
  run.error = "diagnose: no fit";
  run.code = ExitCode::bad_input;
  row = rig_row(run);
  CHECK(row.message == "diagnose: no fit");
  CHECK(row.exit_code == 2);
  run.result.reset();
  row = rig_row(run);
  CHECK_FALSE(row.status.has_value());
  CHECK_FALSE(row.name.has_value());
  CHECK_FALSE(row.has_report);
  CHECK(row.message == "diagnose: no fit");
  CHECK(row.parameters.empty());
}

TEST_CASE("batch row: the worst scores, FAIL before WARN, then by rho2", "[report]") {
  Json result = stored_result();
  Json broken = condition_of("broken", 0.99, "PASS");
  broken["failure"] = "too many steps";
  broken["verdict"] = "FAIL";
  result["conditions"] = {
      condition_of("passes badly", 0.1, "PASS"), condition_of("passes", 0.95, "PASS"),
      condition_of("warned", 0.5, "WARN"),       condition_of("failed", 0.9, "FAIL"),
      condition_of("failed more", 0.8, "FAIL"),  broken};
  const StoredRig row = rig_row(run_of(result));
  CHECK(worst(row) == std::vector<std::string>{"broken", "failed more", "failed"});
  CHECK(row.worst_scores[0].failure == "too many steps");
  CHECK(row.worst_scores[0].verdict == Verdict::fail);
  CHECK_FALSE(row.worst_scores[0].rho2.has_value());
  CHECK(row.worst_scores[1].rho2 == 0.8);
  CHECK(row.worst_scores[1].channel == "position");
  CHECK(row.worst_scores[1].absolute_error_percent == 0.5);
  CHECK(row.worst_scores[1].failure.empty());
  result["conditions"] = {condition_of("passes", 0.95, "PASS"),
                          condition_of("passes badly", 0.1, "PASS"),
                          condition_of("warned", 0.97, "WARN")};
  CHECK(worst(rig_row(run_of(result))) ==
        std::vector<std::string>{"warned", "passes badly", "passes"});
  // A score without a number could have any value, so it is listed before the others.
  result["conditions"][0]["metrics"]["position"]["rho2"] = nullptr;
  CHECK(worst(rig_row(run_of(result))) ==
        std::vector<std::string>{"warned", "passes", "passes badly"});
  result["conditions"] = Json::array({condition_of("one", 0.95, "PASS")});
  CHECK(worst(rig_row(run_of(result))).size() == 1);
}

TEST_CASE("batch row: every reason that is no pass, with its aspect", "[report]") {
  Json result = stored_result();
  const auto reason = [](const char* state, const char* words) {
    return Json{{"code", "c"},
                {"state", state},
                {"subject", nullptr},
                {"numbers", Json::object()},
                {"words", words}};
  };
  result["assessment"]["agreement"]["reasons"] =
      Json::array({reason("fail", "beyond"), reason("pass", "kept")});
  result["assessment"]["adequacy"]["reasons"] = Json::array({reason("reservation", "misfit")});
  result["assessment"]["parameters"]["reasons"] = Json::array({reason("reservation", "none")});
  CHECK(rig_row(run_of(result)).reasons ==
        std::vector<std::string>{"agreement: beyond", "adequacy: misfit", "parameters: none"});
}

TEST_CASE("batch row: estimates, neither known values nor nuisance parameters", "[report]") {
  Json result = stored_result();
  Json nuisance = result["parameters"][0];
  nuisance["name"] = nuisance["key"] = "valve_offset";
  nuisance["nuisance"] = true;
  result["parameters"].push_back(nuisance);
  Json of_level = result["parameters"][0];
  of_level["name"] = of_level["key"] = "leakage_coefficient";
  of_level["scope"] = "leak_level";
  of_level["level"] = "33 %";
  of_level["value"] = nullptr;
  of_level["ci95"] = nullptr;
  result["parameters"].push_back(of_level);
  const StoredRig row = rig_row(run_of(result));
  REQUIRE(row.parameters.size() == 2);
  CHECK(row.parameters[0].key == "mass");
  CHECK(row.parameters[0].name == "mass_kg");
  CHECK(row.parameters[0].unit == "kg");
  CHECK(row.parameters[0].value == 85.01139529);
  REQUIRE(row.parameters[0].ci95.has_value());
  CHECK(row.parameters[0].ci95->low == 84.9);
  CHECK(row.parameters[0].ci95->high == 85.1);
  CHECK(row.parameters[1].level == "33 %");
  CHECK(std::isnan(row.parameters[1].value));
  CHECK_FALSE(row.parameters[1].ci95.has_value());
}

TEST_CASE("batch row: a trend takes two results, and each parameter once", "[report]") {
  RigRun run = run_of(stored_result());
  CHECK(rig_row(run).trends.empty());
  run.earlier.push_back(compared_of(stored_result(), "earlier/fit.json", "before"));
  const StoredRig row = rig_row(run);
  REQUIRE(row.trends.size() == 1);
  CHECK(row.trends[0].key == "mass");
  CHECK(row.trends[0].unit == "kg");
  CHECK(row.trends[0].series.points.size() == 2);
  Json levels = stored_result();
  for (const char* level : {"a", "b"}) {
    Json leak = levels["parameters"][0];
    leak["name"] = leak["key"] = "leakage_coefficient";
    leak["scope"] = "leak_level";
    leak["level"] = level;
    levels["parameters"].push_back(leak);
  }
  run = run_of(levels);
  run.earlier.push_back(compared_of(levels, "earlier/fit.json", "before"));
  std::vector<std::string> names;
  for (const StoredRigTrend& each : rig_row(run).trends) names.push_back(trend_name(each));
  CHECK(names ==
        std::vector<std::string>{"mass", "leakage_coefficient (a)", "leakage_coefficient (b)"});
}

TEST_CASE("batch: how the rigs ended is counted, in this order", "[report]") {
  StoredBatch batch;
  batch.rigs = {rig_of("a", FitStatus::converged, Verdict::pass, 0)};
  CHECK(batch_sentence(batch) == "1 rig: 1 PASS");
  batch.rigs = {rig_of("none", std::nullopt, std::nullopt, 2),
                rig_of("failed", FitStatus::failed, Verdict::fail, 3),
                rig_of("stopped", FitStatus::stopped, Verdict::pass, 4),
                rig_of("judged", FitStatus::converged, std::nullopt, 0),
                rig_of("fail", FitStatus::converged, Verdict::fail, 1),
                rig_of("warn", FitStatus::converged, Verdict::warn, 0),
                rig_of("a", FitStatus::converged, Verdict::pass, 0),
                rig_of("b", FitStatus::converged, Verdict::pass, 0)};
  CHECK(batch_sentence(batch) ==
        "8 rigs: 2 PASS, 1 WARN, 1 FAIL, 1 not judged, 1 stopped, 1 failed, 1 no result");
}

TEST_CASE("batch: a trend in words", "[report]") {
  CHECK(trend_sentence(trend_of("rig", 0.001, true)) ==
        "leakage_coefficient: +0.001 per day (0.0005 to 0.0015): significant trend.");
  StoredRigTrend trend = trend_of("33 %", -0.002, false);
  trend.unit = "kg";
  CHECK(trend_sentence(trend) ==
        "leakage_coefficient (33 %): -0.002 kg per day (-0.001 to -0.003): no significant trend.");
  trend.series.along_date.ci95.reset();
  trend.series.along_date.reason = "fewer than three estimates";
  CHECK(trend_sentence(trend) == "leakage_coefficient (33 %): fewer than three estimates.");
  CHECK(is_significant(trend_of("rig", 1.0, true)));
  CHECK_FALSE(is_significant(trend_of("rig", 1.0, false)));
  trend.series.along_date.significant.reset();
  CHECK_FALSE(is_significant(trend));
}

TEST_CASE("batch: on the terminal a line for each rig, then what is wrong with it", "[report]") {
  StoredBatch batch;
  StoredRig good = rig_of("good", FitStatus::converged, Verdict::pass, 0);
  good.unchanged = true;
  good.seconds = 0.46;
  good.trends = {trend_of("rig", 0.001, true), trend_of("33 %", 0.002, false)};
  StoredRigScore score;
  score.condition = "sine";
  score.channel = "position";
  score.rho2 = 0.98765;
  good.worst_scores = {score};
  StoredRig fails = rig_of("fails", FitStatus::converged, Verdict::fail, 1);
  fails.reasons = {"agreement: beyond", "adequacy: misfit"};
  score.failure = "too many steps";
  fails.worst_scores = {score};
  StoredRig stopped = rig_of("stopped", FitStatus::stopped, std::nullopt, 4);
  StoredRig diagnosed = rig_of("diagnosed", FitStatus::converged, Verdict::pass, 2);
  score.failure.clear();
  score.rho2.reset();
  diagnosed.worst_scores = {score};
  batch.rigs = {good, fails, stopped, diagnosed};
  const std::string text =
      rigcal::report::doc::render_terminal({batch_headline(batch), {}, batch_sections(batch)}, {});
  CHECK_THAT(text, Contains("4 rigs: 2 PASS, 1 FAIL, 1 stopped."));
  CHECK_THAT(text, Contains("unchanged") && Contains("sine position: 0.9877") &&
                       Contains("sine: not simulated") && Contains("sine position: –"));
  CHECK_THAT(text, Contains("good: leakage_coefficient: +0.001 per day"));
  CHECK_THAT(text, !Contains("33 %"));
  CHECK_THAT(text, !Contains("message of good"));
  CHECK_THAT(text, Contains("agreement: beyond") && Contains("adequacy: misfit"));
  CHECK_THAT(text, !Contains("message of fails"));
  CHECK_THAT(text, Contains("message of stopped") && Contains("message of diagnosed"));
}

TEST_CASE("batch: a verdict of FAIL is a result, a run that failed leaves the batch incomplete",
          "[report]") {
  StoredBatch batch;
  const auto words = [&](int exit_code, std::optional<Verdict> verdict) {
    batch.exit_code = exit_code;
    batch.rigs = {rig_of("a", FitStatus::converged, verdict, exit_code)};
    return batch_headline(batch).badge.words;
  };
  CHECK(words(0, Verdict::pass) == "PASS");
  CHECK(words(0, Verdict::warn) == "WARN");
  CHECK(words(0, std::nullopt) == "DONE");
  CHECK(words(1, Verdict::fail) == "FAIL");
  CHECK(words(2, std::nullopt) == "INCOMPLETE");
  CHECK(words(4, Verdict::pass) == "INCOMPLETE");
}

TEST_CASE("batch: the line of a trend is drawn where it is", "[report]") {
  // Two points on the line, whose days count from 1970.
  StoredRigTrend trend = trend_of("rig", 1e-3, true);
  trend.series.along_date.intercept = -19.7;
  for (const double day : {20000.0, 20050.0}) {
    StoredTrendPoint& point = trend.series.points.emplace_back();
    point.day = day;
    point.value = 1e-3 * day - 19.7;
  }
  StoredBatch batch;
  batch.rigs = {rig_of("a", FitStatus::converged, Verdict::pass, 0)};
  batch.rigs.front().trends = {trend};
  const auto figures = batch_figures(batch);
  REQUIRE(figures.size() == 1);
  const auto trace_of = [&](Trace::Kind kind) {
    for (const Trace& each : figures.front().plot.traces)
      if (each.kind == kind) return each;
    return Trace{};
  };
  const Trace points = trace_of(Trace::Kind::points);
  const Trace line = trace_of(Trace::Kind::line);
  REQUIRE(points.y.size() == 2);
  CHECK(line.x == points.x);
  for (std::size_t i = 0; i < 2; ++i) CHECK_THAT(line.y.at(i), Catch::WithinAbs(points.y[i], 1e-9));
  CHECK(trace_of(Trace::Kind::band).x.empty());  // these points have no errors
}

TEST_CASE("batch: the line of a trend has its 95 % band", "[report]") {
  StoredRigTrend trend = trend_of("rig", 1e-3, true);
  trend.series.along_date.intercept = -20.0;
  trend.series.along_date.standard_error = 2.5e-4;  // the interval is twice this error wide
  for (const double day : {20000.0, 20050.0, 20100.0}) {
    StoredTrendPoint& point = trend.series.points.emplace_back();
    point.day = day;
    point.value = 1e-3 * day - 20.0;
    point.standard_error = 0.01;
  }
  StoredBatch batch;
  batch.rigs = {rig_of("a", FitStatus::converged, Verdict::pass, 0)};
  batch.rigs.front().trends = {trend};
  const auto figures = batch_figures(batch);
  REQUIRE(figures.size() == 1);
  const Trace& band = figures.front().plot.traces.front();
  REQUIRE(band.kind == Trace::Kind::band);
  CHECK(band.x.front() == 0.0);
  CHECK(band.x.back() == 100.0);
  // At an end: 2 sqrt(0.01^2 / 3 + (2.5e-4 * 50)^2); in the middle, only the first term.
  const auto half_at = [&](std::size_t i) { return 0.5 * (band.upper[i] - band.y[i]); };
  const double level = 2.0 * 0.01 / std::sqrt(3.0);
  const double scale = half_at(band.x.size() / 2) / level;  // unit of the axis
  CHECK_THAT(half_at(0), Catch::WithinRel(scale * std::hypot(level, 2.0 * 0.0125), 1e-6));
  CHECK_THAT(half_at(band.x.size() - 1), Catch::WithinRel(half_at(0), 1e-6));
  CHECK_THAT(scale, Catch::WithinRel(1.0, 1e-6));
}

TEST_CASE("batch: a CSV line for each rig, columns for every estimate of any", "[report]") {
  StoredBatch batch;
  StoredRig a = rig_of("a", FitStatus::converged, Verdict::warn, 1);
  a.name = "rig a";
  a.seconds = 2.5;
  a.unchanged = true;
  a.warnings = {"one", "two"};
  a.reasons = {"first", "second"};
  StoredRigScore score;
  score.condition = "sine";
  score.channel = "position";
  score.rho2 = 0.75;
  score.absolute_error_percent = 1.5;
  a.worst_scores = {score, score};
  StoredRigEstimate mass;
  mass.name = "mass_kg";
  mass.value = 85.0;
  mass.ci95 = rigcal::Range{84.0, 86.5};
  a.parameters = {mass};
  StoredRig b = rig_of("b", std::nullopt, std::nullopt, 2);
  StoredRigEstimate leak;
  leak.name = "leakage_coefficient";
  leak.level = "33 %";
  leak.value = 0.25;
  StoredRig c = rig_of("c", FitStatus::converged, Verdict::pass, 0);
  StoredRigEstimate more = leak;
  more.level = "66 %";
  more.value = 0.75;
  c.parameters = {leak, mass, more};
  batch.rigs = {a, b, c};
  const std::string csv = batch_csv(batch);
  for (const auto& [column, expected] :
       {std::pair{"rig", "a"}, std::pair{"name", "rig a"}, std::pair{"exit_code", "1"},
        std::pair{"status", "converged"}, std::pair{"verdict", "WARN"}, std::pair{"seconds", "2.5"},
        std::pair{"unchanged", "1"}, std::pair{"warnings", "2"},
        std::pair{"message", "message of a"}, std::pair{"first_reason", "first"},
        std::pair{"worst_condition", "sine"}, std::pair{"worst_channel", "position"},
        std::pair{"worst_rho2", "0.75"}, std::pair{"worst_absolute_error_percent", "1.5"},
        std::pair{"mass_kg", "85"}, std::pair{"mass_kg_ci95_low", "84"},
        std::pair{"mass_kg_ci95_high", "86.5"}, std::pair{"leakage_coefficient[33 %]", ""}}) {
    CAPTURE(column);
    CHECK(cell(csv, 1, column) == expected);
  }
  for (const char* column :
       {"name", "status", "verdict", "worst_rho2", "mass_kg", "first_reason", "mass_kg_ci95_low"})
    CHECK(cell(csv, 2, column).empty());
  CHECK(cell(csv, 2, "unchanged") == "0");
  CHECK(cell(csv, 2, "exit_code") == "2");
  CHECK(cell(csv, 3, "leakage_coefficient[33 %]") == "0.25");
  CHECK(cell(csv, 3, "leakage_coefficient[33 %]_ci95_low").empty());
  CHECK(cell(csv, 3, "leakage_coefficient[66 %]") == "0.75");
  CHECK(cell(csv, 3, "mass_kg") == "85");
  CHECK(cells(csv, 0).size() == 23);
}
