#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/document/render_terminal.hpp"
#include "report/page/page_parts.hpp"
#include "tests/report/stored_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests which differences a comparison reports, their size and their order.

using Catch::Contains;
using Catch::WithinRel;
using namespace rigcal::report;
using rigcal::datasets::Scope;
using rigcal::test::ComparedJson;
using rigcal::test::stored_result;

namespace {

/// A fit of the mass to its own records.
ComparedJson fit_of(const std::string& name, double mass_kg, double error_kg = 0.3) {
  Json result = stored_result();
  Json& mass = result["parameters"][0];
  mass["value"] = mass_kg;
  mass["standard_error"] = error_kg;
  mass["degrees_of_freedom"] = 1e6;
  mass["ci95"] = {mass_kg - 1.96 * error_kg, mass_kg + 1.96 * error_kg};
  result["provenance"]["inputs"] = {{{"path", "campaign.toml"}, {"sha256", "same"}},
                                    {{"path", "a/sine_1.csv"}, {"sha256", name}}};
  return {name, name + "/fit.json", result};
}

std::vector<Compared> compared_all(const std::vector<ComparedJson>& results) {
  return {results.begin(), results.end()};
}

rigcal::calib::EstimateDifference difference(const ComparedJson& first, const ComparedJson& other) {
  const auto list = compared_parameters(compared_all({first, other}));
  REQUIRE(list.at(0).key == "mass");
  REQUIRE_FALSE(list[0].differences.at(0).has_value());
  return list[0].differences.at(1).value();
}

/// Returns the reported percentage for a mass with this interval, if there is one.
std::optional<double> percent_of(double value, double low, double high, double other = 20.0) {
  ComparedJson first = fit_of("first", value);
  first.result["parameters"][0]["ci95"] = {low, high};
  return difference(first, fit_of("other", other)).percent;
}

StoredComparedParameter parameter(const std::string& key,
                                  std::optional<rigcal::calib::EstimateDifference> second,
                                  double error = 1.0) {
  StoredComparedParameter result;
  result.name = result.key = key;
  result.unit = "1";
  rigcal::calib::ComparedEstimate estimate;
  estimate.value = 10.0;
  estimate.fitted = true;
  estimate.standard_error = error;
  result.estimates = {estimate, estimate};
  result.differences = {std::nullopt, std::move(second)};
  return result;
}

rigcal::calib::EstimateDifference tested(double size, double p, bool significant) {
  rigcal::calib::EstimateDifference result;
  result.difference = size;
  result.percent = 10.0 * size;
  result.p_value = p;
  result.p_value_of_all = p;
  result.significant = significant;
  return result;
}
rigcal::calib::EstimateDifference untested(double size, const std::string& reason) {
  rigcal::calib::EstimateDifference result;
  result.difference = size;
  result.percent = 10.0 * size;
  result.reason = reason;
  return result;
}

StoredComparison comparison_of(std::vector<StoredComparedParameter> parameters) {
  StoredComparison comparison;
  comparison.results.resize(2);
  comparison.results[0].name = "before";
  comparison.results[1].name = "after";
  comparison.parameters = std::move(parameters);
  return comparison;
}

std::vector<std::string> told(const StoredComparison& comparison) {
  std::vector<std::string> list;
  for (const Change& each : changes_of(comparison))
    list.push_back(each.parameter + " in " + each.result + ": " + each.by);
  return list;
}

}  // namespace

TEST_CASE("comparison: nothing is a percentage of an interval that touches zero", "[report]") {
  CHECK_THAT(*percent_of(10.0, 9.0, 11.0), WithinRel(100.0, 1e-12));
  CHECK_THAT(*percent_of(10.0, 9.0, 11.0, 5.0), WithinRel(-50.0, 1e-12));
  CHECK_THAT(*percent_of(10.0, 1e-9, 11.0), WithinRel(100.0, 1e-12));
  CHECK_FALSE(percent_of(10.0, 0.0, 11.0).has_value());
  CHECK_FALSE(percent_of(10.0, -1.0, 11.0).has_value());
  CHECK_FALSE(percent_of(-10.0, -11.0, 0.0).has_value());
  CHECK_FALSE(percent_of(0.0, 0.0, 0.0).has_value());
  CHECK_THAT(*percent_of(-10.0, -11.0, -1e-9), WithinRel(-300.0, 1e-12));
  ComparedJson first = fit_of("first", 10.0);
  first.result["parameters"][0]["ci95"] = nullptr;
  CHECK(difference(first, fit_of("other", 20.0)).percent.has_value());
}

TEST_CASE("comparison: the difference is the other less the first, with the errors of both",
          "[report]") {
  const rigcal::calib::EstimateDifference found =
      difference(fit_of("a", 85.0, 0.3), fit_of("b", 84.0, 0.4));
  CHECK_THAT(*found.difference, WithinRel(-1.0, 1e-12));
  CHECK_THAT(*found.percent, WithinRel(-100.0 / 85.0, 1e-12));
  CHECK_THAT(*found.standard_error, WithinRel(0.5, 1e-12));
  CHECK(found.p_value.has_value());
  CHECK_FALSE(found.reason.has_value());
  CHECK(*difference(fit_of("a", 85.0), fit_of("b", 85.0)).difference == 0.0);
}

TEST_CASE("comparison: a difference between two dates contains two days", "[report]") {
  const auto on = [](const std::string& name, double mass_kg, const Json& date) {
    ComparedJson fit = fit_of(name, mass_kg, 0.3);
    fit.result["parameters"][0]["between_days_error"] = 1.2;
    for (Json& condition : fit.result["conditions"]) condition["date"] = date;
    return fit;
  };
  const rigcal::calib::EstimateDifference other =
      difference(on("a", 85.0, "2026-03-01"), on("b", 84.0, "2026-03-02"));
  CHECK_THAT(*other.standard_error, WithinRel(std::sqrt(2.0 * (0.09 + 1.44)), 1e-12));
  CHECK(other.of_other_dates == true);
  const rigcal::calib::EstimateDifference same =
      difference(on("a", 85.0, "2026-03-01"), on("b", 84.0, "2026-03-01"));
  CHECK_THAT(*same.standard_error, WithinRel(0.3 * std::sqrt(2.0), 1e-12));
  CHECK_FALSE(same.of_other_dates.has_value());
  CHECK_FALSE(
      difference(on("a", 85.0, nullptr), on("b", 84.0, "2026-03-01")).of_other_dates.has_value());
  // The page mentions the different dates.
  const auto words = [&](const char* date) {
    StoredComparison comparison = comparison_of(
        compared_parameters(compared_all({on("a", 85.0, "2026-03-01"), on("b", 84.0, date)})));
    comparison.significance.resize(2);
    return doc::render_terminal({{}, {}, comparison_sections(comparison)}, {});
  };
  CHECK_THAT(words("2026-03-02"), Contains("Fits of different dates"));
  CHECK_THAT(words("2026-03-01"), !Contains("Fits of different dates"));
  // Each point on a trend has a different day.
  const auto points = trends(compared_all({on("a", 85.0, "2026-03-01")}), "mass").at(0).points;
  CHECK_THAT(*points.at(0).standard_error, WithinRel(std::hypot(0.3, 1.2), 1e-12));
}

TEST_CASE("comparison: a trend knows whether its points count their days", "[report]") {
  // Chi-square is 3.2 with 2 degrees of freedom: 20 %, which widens where days are not counted.
  const double error = std::hypot(0.3, 1.2);
  const auto widened = [&](double own_error, double days_error) {
    std::vector<ComparedJson> fits;
    for (int i = 0; i < 4; ++i) {
      ComparedJson& fit = fits.emplace_back(fit_of(std::string(1, static_cast<char>('a' + i)),
                                                   85.0 + 2.0 * error * (i % 2), own_error));
      fit.result["parameters"][0]["between_days_error"] = days_error;
      for (Json& condition : fit.result["conditions"])
        condition["date"] = "2026-03-0" + std::to_string(1 + i);
    }
    const auto list = trends(compared_all(fits), "mass");
    return list.at(0).along_date.widened.value();
  };
  CHECK(widened(0.3, 1.2) == 1.0);
  CHECK_THAT(widened(error, 0.0), WithinRel(std::sqrt(1.6), 1e-6));
}

TEST_CASE("comparison: a known value has no error, and is not fitted to anything", "[report]") {
  ComparedJson known = fit_of("known", 80.0);
  known.result["parameters"][0]["fitted"] = false;
  known.result["parameters"][0]["ci95"] = nullptr;
  for (const bool first : {true, false}) {
    const ComparedJson fitted = fit_of("fitted", 85.0, 0.3);
    const rigcal::calib::EstimateDifference found =
        first ? difference(known, fitted) : difference(fitted, known);
    CHECK_THAT(*found.difference, WithinRel(first ? 5.0 : -5.0, 1e-12));
    CHECK_THAT(*found.standard_error, WithinRel(0.3, 1e-12));
    CHECK(found.significant == true);
  }
  // Known values do not depend on the records, so using the same records makes no difference.
  ComparedJson same = fit_of("fitted", 85.0);
  same.result["provenance"]["inputs"] = known.result["provenance"]["inputs"];
  CHECK(difference(known, same).significant == true);
  ComparedJson other = known;
  other.result["parameters"][0]["value"] = 81.0;
  const rigcal::calib::EstimateDifference both = difference(known, other);
  CHECK(both.reason == std::string(rigcal::calib::kKnownInBoth));
  CHECK_THAT(*both.difference, WithinRel(1.0, 1e-12));
  CHECK_FALSE(both.standard_error.has_value());
}

TEST_CASE("comparison: an estimate without an error is not tested, nor one of no error",
          "[report]") {
  ComparedJson without = fit_of("without", 80.0);
  without.result["parameters"][0]["standard_error"] = nullptr;
  for (const bool first : {true, false}) {
    const ComparedJson other = fit_of("other", 85.0);
    const rigcal::calib::EstimateDifference found =
        first ? difference(without, other) : difference(other, without);
    CHECK(found.reason == "an estimate has no standard error");
    CHECK_FALSE(found.significant.has_value());
    CHECK(found.difference.has_value());
  }
  CHECK(difference(fit_of("a", 80.0, 0.0), fit_of("b", 81.0, 0.0)).reason ==
        "an estimate has no standard error");
}

TEST_CASE("comparison: a parameter is the same by name, scope and level", "[report]") {
  ComparedJson other = fit_of("other", 90.0);
  other.result["parameters"][0]["scope"] = "leak_level";
  other.result["parameters"][0]["level"] = "33 %";
  Json second = other.result["parameters"][0];
  second["level"] = "66 %";
  other.result["parameters"].push_back(second);
  Json nuisance = other.result["parameters"][0];
  nuisance["name"] = nuisance["key"] = "valve_offset";
  nuisance["nuisance"] = true;
  other.result["parameters"].push_back(nuisance);
  const auto list = compared_parameters(compared_all({fit_of("first", 85.0), other}));
  REQUIRE(list.size() == 4);  // mass of the rig, known pressure, mass for each of two levels
  CHECK_FALSE(list[0].estimates[1].has_value());
  CHECK_FALSE(list[0].differences[1].has_value());
  CHECK(list[2].level == "33 %");
  CHECK(list[3].level == "66 %");
  CHECK_FALSE(list[2].estimates[0].has_value());
  CHECK(list[2].estimates[1]->value == 90.0);
}

TEST_CASE("comparison: a change in percent, else in a unit with few digits", "[report]") {
  rigcal::calib::EstimateDifference change;
  change.difference = 0.00031234;
  CHECK(change_text(change, {"mm", 1e-3}) == "+0.31 mm");
  CHECK(change_text(change, {"", 1.0}) == "+0.00031");
  change.difference = -0.002;
  CHECK(change_text(change, {"mm", 1e-3}) == "-2 mm");
  change.percent = -1.23456;
  CHECK(change_text(change, {"mm", 1e-3}) == "-1.23 %");
  change.percent = 150.0;
  CHECK(change_text(change, {"mm", 1e-3}) == "+150 %");
  CHECK(change_text({}, {"mm", 1e-3}).empty());
}

TEST_CASE("comparison: the unit is that of the largest estimate", "[report]") {
  StoredComparedParameter pressure = parameter("supply_pressure", std::nullopt);
  pressure.unit = "Pa";
  pressure.estimates[0]->value = -7e6;
  pressure.estimates[1]->value = 3.0;
  CHECK(unit_of_estimates(pressure).name == rigcal::readable_unit(7e6, "Pa").name);
  CHECK(unit_of_estimates(pressure).si == rigcal::readable_unit(7e6, "Pa").si);
  REQUIRE(rigcal::readable_unit(7e6, "Pa").si != rigcal::readable_unit(3.0, "Pa").si);
}

TEST_CASE("comparison: rows of what some result estimates, or of known values that differ",
          "[report]") {
  CHECK(worth_a_row(parameter("estimated", std::nullopt)));
  StoredComparedParameter known = parameter("known", untested(0.0, rigcal::calib::kKnownInBoth));
  known.estimates[0]->fitted = false;
  CHECK(worth_a_row(known));
  known.estimates[1]->fitted = false;
  CHECK_FALSE(worth_a_row(known));
  known.differences[1] = untested(1e-9, rigcal::calib::kKnownInBoth);
  CHECK(worth_a_row(known));
  known.differences[1] = untested(-1e-9, rigcal::calib::kKnownInBoth);
  CHECK(worth_a_row(known));
}

TEST_CASE("comparison: changes, the surest first, then what was not tested by its size",
          "[report]") {
  const auto list = told(comparison_of({
      parameter("untested_small", untested(1.0, "why")),
      parameter("sure", tested(2.0, 0.01, true)),
      parameter("no_change", tested(0.0, 1.0, true)),
      parameter("insignificant", tested(9.0, 0.2, false)),
      parameter("known", untested(5.0, rigcal::calib::kKnownInBoth)),
      parameter("untested_large", untested(-3.0, "why")),
      parameter("untested_none", untested(0.0, "why")),
      parameter("surest", tested(-1.0, 0.001, true)),
      parameter("absent", std::nullopt),
      parameter("untested_sharp", untested(1.0, "why"), 0.1),
  }));
  CHECK(list == std::vector<std::string>{"surest in after: -10 %", "sure in after: +20 %",
                                         "untested_sharp in after: +10 %",
                                         "untested_large in after: -30 %",
                                         "untested_small in after: +10 %"});
}

TEST_CASE("comparison: of changes as sure as each other the largest comes first", "[report]") {
  CHECK(told(comparison_of({parameter("small", tested(1.0, 0.01, true)),
                            parameter("large", tested(2.0, 0.01, true))})) ==
        std::vector<std::string>{"large in after: +20 %", "small in after: +10 %"});
  const auto changes = changes_of(comparison_of(
      {parameter("a", tested(1.0, 0.01, true)), parameter("b", untested(1.0, "no error"))}));
  REQUIRE(changes.size() == 2);
  CHECK(changes[0].p == 0.01);
  CHECK(changes[0].reason.empty());
  CHECK_FALSE(changes[1].p.has_value());
  CHECK(changes[1].reason == "no error");
}

TEST_CASE("comparison: what was tested is counted, and what not is named with its reason",
          "[report]") {
  const auto counted = [](const std::vector<StoredComparedParameter>& parameters) {
    const auto list = tested_parameters(parameters, 2);
    REQUIRE(list.size() == 2);
    REQUIRE_FALSE(list[0].has_value());
    return *list[1];
  };
  const StoredSignificance found = counted(
      {parameter("a", tested(1.0, 0.01, true)), parameter("b", tested(1.0, 0.2, false)),
       parameter("c", untested(1.0, "one")), parameter("d", untested(1.0, "two")),
       parameter("e", untested(1.0, "one")),
       parameter("f", untested(1.0, rigcal::calib::kKnownInBoth)), parameter("g", std::nullopt)});
  CHECK(found.compared == 5);
  CHECK(found.tested == 2);
  CHECK(found.significant == 1);
  CHECK(found.text ==
        "5 parameters compared, 2 tested, 1 significant difference; not tested: c, e, because one; "
        "not tested: d, because two");
  CHECK(counted({parameter("a", tested(1.0, 0.2, false))}).text ==
        "1 parameter compared, 1 tested, no significant difference");
  CHECK(counted({parameter("a", tested(1.0, 0.01, true)), parameter("b", tested(1.0, 0.01, true))})
            .text == "2 parameters compared, 2 tested, 2 significant differences");
  CHECK(counted({}).text == "0 parameters compared, 0 tested");
}

TEST_CASE("comparison: records by their content, whatever their names", "[report]") {
  ComparedJson a = fit_of("a", 85.0);
  ComparedJson b = fit_of("b", 85.0);
  a.result["provenance"]["inputs"] = {{{"path", "campaign.toml"}, {"sha256", "same"}},
                                      {{"path", "old/fit.json"}, {"sha256", "fit"}},
                                      {{"path", "x/one.csv"}, {"sha256", "1"}},
                                      {{"path", "x/two.csv"}, {"sha256", "2"}}};
  b.result["provenance"]["inputs"] = {{{"path", "campaign.toml"}, {"sha256", "same"}},
                                      {{"path", "old/fit.json"}, {"sha256", "fit"}},
                                      {{"path", "y/zwei.csv"}, {"sha256", "2"}},
                                      {{"path", "y/one.csv"}, {"sha256", "3"}}};
  const auto list = compared_records(compared_all({a, b}));
  REQUIRE(list.size() == 3);
  CHECK(list[0].file == "one.csv");
  CHECK(list[0].sha256 == "1");
  CHECK(list[0].in == std::vector<bool>{true, false});
  CHECK(list[1].sha256 == "3");
  CHECK(list[1].in == std::vector<bool>{false, true});
  CHECK(list[2].sha256 == "2");
  CHECK(list[2].file == "two.csv");
  CHECK(list[2].in == std::vector<bool>{true, true});
  CHECK(share_records(a, b));
  b.result["provenance"]["inputs"][2]["sha256"] = "4";
  CHECK_FALSE(share_records(a, b));  // campaign file and earlier fit are not records
  CHECK(record_hashes(Compared(b).result).size() == 2);
}

TEST_CASE("comparison: dates and temperatures of a result from its first to its last", "[report]") {
  ComparedJson result = fit_of("a", 85.0);
  for (const auto& [date, kelvin] : {std::pair{"2026-03-05", 310.0}, std::pair{"2026-01-07", 300.0},
                                     std::pair{"2026-02-01", 320.0}}) {
    Json condition = result.result["conditions"][0];
    condition["id"] = date;
    condition["date"] = date;
    condition["temperature_k"] = kelvin;
    result.result["conditions"].push_back(condition);
  }
  const StoredComparison found = compared(compared_all({result, fit_of("b", 85.0)}), {});
  CHECK(found.results[0].dates == std::array<std::string, 2>{"2026-01-07", "2026-03-05"});
  REQUIRE(found.results[0].temperature_k.has_value());
  CHECK(found.results[0].temperature_k->low == 300.0);
  CHECK(found.results[0].temperature_k->high == 320.0);
  CHECK(found.results[0].conditions == 4);
  CHECK(found.results[1].conditions == 1);
  CHECK_FALSE(found.results[1].dates.has_value());
  CHECK_FALSE(found.results[1].temperature_k.has_value());
  CHECK(found.status == "done");
}

TEST_CASE("comparison: what speaks against a result is said by its name", "[report]") {
  ComparedJson stopped = fit_of("early", 85.0);
  stopped.result["status"] = "stopped";
  stopped.result["message"] = "limit of time";
  ComparedJson failing = fit_of("bad", 85.0);
  failing.result["verdict"] = "FAIL";
  ComparedJson warned = fit_of("near", 85.0);
  warned.result["verdict"] = "WARN";
  ComparedJson same = fit_of("again", 85.0);
  same.result["provenance"]["inputs"] = stopped.result["provenance"]["inputs"];
  const auto warnings = compared(compared_all({stopped, failing, warned, same}), {}).warnings;
  REQUIRE(warnings.size() == 3);
  CHECK(warnings[0] == "early: stopped: limit of time");
  CHECK_THAT(warnings[1], Contains("bad: outside the campaign's limits (FAIL)"));
  CHECK_THAT(warnings[2], Contains("early and again ") && Contains("the same records"));
}

TEST_CASE("comparison: two usable results are needed, a stopped one is usable", "[report]") {
  ComparedJson stopped = fit_of("stopped", 85.0);
  stopped.result["status"] = "stopped";
  ComparedJson failed = fit_of("failed", 85.0);
  failed.result["status"] = "failed";
  const auto status = [](const std::vector<ComparedJson>& results) {
    return compared(compared_all(results), {}).status;
  };
  CHECK(status({fit_of("a", 85.0), stopped}) == "done");
  CHECK(status({fit_of("a", 85.0), failed}) == "failed");
  CHECK(status({fit_of("a", 85.0), failed, stopped}) == "done");
  CHECK(status({failed, stopped}) == "failed");
}

TEST_CASE("comparison: scores by mean over the conditions of both, an error the better if lower",
          "[report]") {
  ComparedJson first = fit_of("a", 85.0);
  ComparedJson other = fit_of("b", 85.0);
  const auto add = [](ComparedJson& result, const std::string& id, double rho2, double error) {
    Json condition = result.result["conditions"][0];
    condition["id"] = id;
    condition["metrics"]["position"]["rho2"] = rho2;
    condition["metrics"]["position"]["absolute_error_percent"] = error;
    result.result["conditions"].push_back(condition);
  };
  first.result["conditions"] = Json::array({first.result["conditions"][0]});
  add(first, "c1", 0.8, 2.0);
  add(other, "c1", 0.9, 1.0);
  add(first, "c2", 0.6, 3.0);
  add(other, "c2", 0.5, 2.0);
  add(first, "c3", 0.7, 1.0);  // only in the second result
  const auto conditions = compared_conditions(compared_all({first, other}));
  REQUIRE(conditions.size() == 4);
  CHECK(conditions[1].id == "c1");
  CHECK(conditions[1].scores[1]->rho2 == 0.9);
  CHECK_FALSE(conditions[3].scores[1].has_value());
  const auto metrics = compared_metrics(conditions, compared_all({first, other}));
  REQUIRE(metrics.size() == 3);
  const auto& rho2 = *metrics[0].against_first[1];
  CHECK(metrics[0].metric == "rho2");
  CHECK(rho2.conditions == 3);
  CHECK_THAT(rho2.mean_of_first, WithinRel((0.99876543 + 0.8 + 0.6) / 3.0, 1e-12));
  CHECK_THAT(rho2.mean, WithinRel((0.99876543 + 0.9 + 0.5) / 3.0, 1e-12));
  CHECK(rho2.better == 1);
  CHECK(rho2.worse == 1);
  const auto& error = *metrics[2].against_first[1];
  CHECK(metrics[2].metric == "absolute_error_percent");
  CHECK(error.better == 2);
  CHECK(error.worse == 0);
  CHECK_THAT(error.mean, WithinRel(3.5 / 3.0, 1e-12));
}

TEST_CASE("comparison: results are named by as much of their paths as tells them apart",
          "[report]") {
  const rigcal::test::TemporaryFolder folder;
  Json validation = stored_result();
  validation["schema"] = "rigcal.validation/1";
  for (const char* path : {"a/x/fit.json", "b/x/fit.json", "b/y/fit.json", "d/fit.json"})
    folder.write(path, stored_result().dump());
  for (const char* path : {"c/validation.json", "d/validation.json"})
    folder.write(path, validation.dump());
  folder.write("empty/report.html", "");
  const auto names = [&](const std::vector<std::string>& folders) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& each : folders) paths.push_back(folder / each);
    std::vector<std::string> found;
    for (const Compared& each : load_compared(paths)) found.push_back(each.name);
    return found;
  };
  CHECK(names({"a/x", "b/y"}) == std::vector<std::string>{"x", "y"});
  CHECK(names({"a/x", "b/x"}) == std::vector<std::string>{"a/x", "b/x"});
  CHECK(names({"a/x", "b/x", "b/y"}) == std::vector<std::string>{"a/x", "b/x", "b/y"});
  CHECK(names({"c", "d/"}) == std::vector<std::string>{"c", "d"});
  const auto found = load_compared({folder / "c", folder / "d"});
  CHECK(found[0].file == folder / "c/validation.json");
  CHECK(found[1].file == folder / "d/fit.json");
  CHECK_THROWS_WITH(load_compared({folder / "a/x", folder / "empty"}),
                    Contains("empty: found neither fit.json nor validation.json"));
}

TEST_CASE("comparison: a comparison.json whose lists are too short is refused by key", "[report]") {
  const StoredComparison whole = compared(compared_all({fit_of("a", 85.0), fit_of("b", 86.0)}), {});
  const auto complaint = [](const StoredComparison& comparison) -> std::string {
    const std::string text = json_of(comparison).dump();
    try {
      load_comparison(rigcal::test::reading([&](const auto&) { return std::optional(text); }),
                      "folder");
    } catch (const rigcal::InputError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(complaint(whole).empty());
  const auto broken = [&](const auto& change) {
    StoredComparison copy = whole;
    change(copy);
    return complaint(copy);
  };
  const std::string expected = "found 1 entries, expected one for each of the 2 results";
  CHECK_THAT(broken([](auto& c) { c.significance.pop_back(); }),
             Contains("'significance': " + expected));
  CHECK_THAT(broken([](auto& c) { c.models.pop_back(); }), Contains("'models': " + expected));
  CHECK_THAT(broken([](auto& c) { c.parameters.back().estimates.pop_back(); }),
             Contains("'parameters.estimates': " + expected));
  CHECK_THAT(broken([](auto& c) { c.parameters.front().differences.pop_back(); }),
             Contains("'parameters.differences': " + expected));
  CHECK_THAT(broken([](auto& c) { c.conditions.front().scores.pop_back(); }),
             Contains("'conditions.scores': " + expected));
  CHECK_THAT(broken([](auto& c) { c.metrics.front().against_first.pop_back(); }),
             Contains("'metrics.against_first': " + expected));
  CHECK_THAT(broken([](auto& c) {
               c.records.push_back({"a.csv", "0f", {true}});
             }),
             Contains("'records.in': " + expected));
}

TEST_CASE("comparison: estimates of one fit, each of its own conditions, make a trend",
          "[report]") {
  ComparedJson fit = fit_of("one", 85.0);
  fit.result["conditions"] = Json::array();
  const Json condition = stored_result()["conditions"][0];
  Json parameters = Json::array();
  for (int i = 0; i < 4; ++i) {
    Json own = condition;
    own["id"] = "c" + std::to_string(i);
    own["date"] = "2026-03-0" + std::to_string(1 + 2 * i);
    own["leak_level"] = "33 %";
    fit.result["conditions"].push_back(own);
    Json leak = fit.result["parameters"][0];
    leak["name"] = leak["key"] = "leakage_coefficient";
    leak["scope"] = "condition";
    leak["level"] = own["id"];
    leak["value"] = 0.3 + 0.02 * i;
    leak["standard_error"] = 0.001;
    parameters.push_back(leak);
  }
  for (const Json& each : parameters) fit.result["parameters"].push_back(each);
  const auto list = trends({Compared(fit)}, "leakage_coefficient");
  REQUIRE(list.size() == 1);
  CHECK(list[0].of == "33 %");
  REQUIRE(list[0].points.size() == 4);
  CHECK(list[0].points[2].level == "c2");
  CHECK(*list[0].points[2].day - *list[0].points[0].day == 4.0);
  // All estimates come from the same files, but each level from different records.
  CHECK_FALSE(list[0].along_date.reason.has_value());
  CHECK(list[0].along_date.points == 4);
  CHECK_THAT(*list[0].along_date.slope, WithinRel(0.01, 1e-9));
  // Other parameters and known values have no trend.
  CHECK(trends({Compared(fit)}, "damping").empty());
  CHECK(trends({Compared(fit)}, "supply_pressure").empty());
}

TEST_CASE("comparison: an estimate lies at the mean of the days of its conditions", "[report]") {
  ComparedJson fit = fit_of("one", 85.0);
  const Json condition = stored_result()["conditions"][0];
  fit.result["conditions"] = Json::array();
  for (const auto& [id, day, level, use] :
       {std::tuple{"a", "01", "none", "fit"}, std::tuple{"b", "03", "33 %", "fit"},
        std::tuple{"c", "08", "none", "fit"}, std::tuple{"d", "30", "none", "validate"}}) {
    Json own = condition;
    own["id"] = id;
    own["date"] = std::string("2026-03-") + day;
    own["temperature_k"] = 300.0 + std::stoi(day);
    own["leak_level"] = level;
    own["use"] = use;
    fit.result["conditions"].push_back(own);
  }
  Json undated = condition;
  undated["id"] = "e";
  fit.result["conditions"].push_back(undated);
  const auto place = [&](const char* scope, const Json& level) {
    Json& mass = fit.result["parameters"][0];
    mass["scope"] = scope;
    mass["level"] = level;
    const auto list = trends({Compared(fit)}, "mass");
    REQUIRE(list.size() == 1);
    REQUIRE(list[0].points.size() == 1);
    const StoredTrendPoint& point = list[0].points[0];
    CHECK_THAT(*point.temperature_k - 300.0, WithinRel(*point.day - 20512.0, 1e-9));
    return *point.day - 20512.0;  // day in March 2026
  };
  CHECK_THAT(place("rig", nullptr), WithinRel(4.0, 1e-12));
  CHECK_THAT(place("leak_level", "none"), WithinRel(4.5, 1e-12));
  CHECK_THAT(place("leak_level", "33 %"), WithinRel(3.0, 1e-12));
  CHECK_THAT(place("condition", "c"), WithinRel(8.0, 1e-12));
}
