#include "report/comparison/comparison.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "report/document/render_html.hpp"
#include "report/document/render_terminal.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/text_table.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using Catch::WithinRel;
using rigcal::report::Json;
using rigcal::report::Provenance;
using rigcal::report::StoredComparison;
using rigcal::report::text_width;
using rigcal::test::ComparedJson;
using rigcal::test::stored_result;

namespace {

Json comparison_json(const std::vector<ComparedJson>& results, const Provenance& provenance) {
  return json_of(rigcal::report::compared({results.begin(), results.end()}, provenance));
}

/// Reads back comparison.json.
StoredComparison read_back(const Json& json) {
  return rigcal::report::as<StoredComparison>(json, "", "comparison.json");
}

std::string comparison_text(const Json& json, const rigcal::report::Style& style) {
  const StoredComparison comparison = read_back(json);
  return rigcal::report::doc::render_terminal({rigcal::report::comparison_headline(comparison),
                                               {},
                                               rigcal::report::comparison_sections(comparison)},
                                              style);
}

rigcal::report::doc::Verdict comparison_headline(const Json& json) {
  return rigcal::report::comparison_headline(read_back(json));
}

/// Returns the text of a reason, which is a link.
std::string reason_of(const rigcal::report::doc::Verdict& verdict, std::size_t i) {
  return std::get<rigcal::report::doc::Link>(verdict.reasons.at(i).front()).words;
}

std::string sentence_of(const rigcal::report::doc::Verdict& verdict) {
  return rigcal::report::doc::html(verdict.sentence);
}

/// A fit with this mass and leak, to its own records.
ComparedJson compared_fit(const std::string& name, double mass_kg, double leak,
                          double day_shift = 0.0) {
  Json result = stored_result();
  result["parameters"][0]["value"] = mass_kg;
  result["parameters"][0]["standard_error"] = 0.3;
  result["parameters"][0]["robust_standard_error"] = 0.4;
  result["parameters"][0]["ci95_from"] = "robust_standard_error";
  result["parameters"][0]["degrees_of_freedom"] = 1e6;
  Json leakage = result["parameters"][0];
  leakage["name"] = leakage["key"] = "leakage_coefficient";
  leakage["unit"] = "1";
  leakage["value"] = leak;
  leakage["standard_error"] = 0.01;
  leakage["robust_standard_error"] = nullptr;
  leakage["ci95_from"] = "standard_error";
  leakage["ci95"] = {leak - 0.02, leak + 0.02};
  result["parameters"].push_back(leakage);
  const int day = 1 + static_cast<int>(day_shift);
  result["conditions"][0]["date"] =
      "2026-03-" + std::string(day < 10 ? "0" : "") + std::to_string(day);
  result["conditions"][0]["temperature_k"] = 311.15;
  result["provenance"]["inputs"] = {{{"path", "campaign.toml"}, {"sha256", "same"}},
                                    {{"path", "a/sine_1.csv"}, {"sha256", name}}};
  return {name, name + "/fit.json", result};
}

}  // namespace

TEST_CASE("comparison: the difference with the errors that the intervals rest on", "[report]") {
  const Json json =
      comparison_json({compared_fit("before", 85.0, 0.3), compared_fit("after", 86.0, 0.3)}, {});
  CHECK(json["status"] == "done");
  const Json& mass = json["parameters"][0];
  CHECK(mass["name"] == "mass_kg");
  const Json& difference = mass["differences"][1];
  CHECK(difference["difference"] == 1.0);
  CHECK_THAT(difference["percent"].get<double>(), WithinRel(100.0 / 85.0, 1e-12));
  CHECK_THAT(difference["standard_error"].get<double>(), WithinRel(std::hypot(0.4, 0.4), 1e-12));
  // 2 Phi(-1.7678), computed independently (scipy.stats.norm)
  CHECK_THAT(difference["p_value"].get<double>(), WithinRel(0.07709987174, 1e-8));
  // The smallest of two p-values; the other one is 1.
  CHECK_THAT(difference["p_value_of_all"].get<double>(), WithinRel(2.0 * 0.07709987174, 1e-8));
  CHECK(difference["significant"] == false);
}

TEST_CASE("comparison: what both models leave out counts by how differently it moves them",
          "[report]") {
  const auto with = [](const std::string& name, double mass_kg, double moved_by) {
    ComparedJson compared = compared_fit(name, mass_kg, 0.3);
    compared.result["parameters"][0]["budget"] = Json::parse(
        R"({"lines": [{"source": "noise", "kind": "records", "uncertainty": 0.4},
                      {"source": "valve_time_constant", "kind": "effect", "uncertainty": 1.0}],
            "combined": 1.1, "degrees_of_freedom": 1e6, "coverage_factor": 1.96, "expanded": 2.2,
            "shift": 0.0})");
    compared.result["parameters"][0]["budget"]["lines"][1]["sensitivity"] = moved_by;
    compared.result["considered"] = Json::parse(
        R"({"effects": [{"key": "valve_time_constant", "meaning": "lag of the valve", "unit": "s",
            "size_from": "", "size": 5e-4, "one_sided": true, "problem": null, "estimate": 3e-4,
            "standard_error": 4e-4, "alone": null, "alone_half_width": null, "p_value": null,
            "p_of_all": null, "explains": 0.0}],
            "left_out": [], "missing": [], "refitted": [], "correlation": [[1.0]]})");
    return compared;
  };
  const auto difference = [&](double moved, double other_moved) {
    const Json json =
        comparison_json({with("before", 85.0, moved), with("after", 86.0, other_moved)}, {});
    return json["parameters"][0]["differences"][1];
  };
  const Json same = difference(4e3, 4e3);
  CHECK_THAT(same["standard_error"].get<double>(), WithinRel(std::hypot(0.4, 0.4), 1e-12));
  CHECK_FALSE(same.contains("by_effects"));
  // Square root of the second moment, 5e-4 s, times the difference in shift per second.
  const Json other = difference(4e3, 1e3);
  CHECK_THAT(other["by_effects"].get<double>(), WithinRel(1.5, 1e-9));
  CHECK_THAT(other["standard_error"].get<double>(), WithinRel(std::hypot(0.4, 0.4, 1.5), 1e-9));
}

TEST_CASE("comparison: a clear change is significant, and said so", "[report]") {
  const Json json =
      comparison_json({compared_fit("before", 85.0, 0.3), compared_fit("after", 85.0, 0.6)}, {});
  CHECK(json["parameters"][2]["differences"][1]["significant"] == true);
  CHECK(json["parameters"][1]["differences"][1]["reason"] == "known in both");
  const std::string text = comparison_text(json, {});
  CHECK_THAT(text, Contains("+100 % significant p"));
  CHECK_THAT(text, Contains("before") && Contains("after"));
}

TEST_CASE("comparison: several differences are judged together", "[report]") {
  // Each differs by 2.1 standard errors, p = 0.036 (2 Phi(-2.1)): significant on its own, but not
  // as one of two.
  const double mass_kg = 85.0 + 2.1 * std::hypot(0.4, 0.4);
  const double leak = 0.3 + 2.1 * std::hypot(0.01, 0.01);
  const Json both = comparison_json(
      {compared_fit("before", 85.0, 0.3), compared_fit("after", mass_kg, leak)}, {});
  for (const std::size_t i : {0U, 2U}) {
    const Json& difference = both["parameters"][i]["differences"][1];
    CHECK_THAT(difference["p_value"].get<double>(), WithinRel(0.035728841, 1e-6));
    CHECK_THAT(difference["p_value_of_all"].get<double>(), WithinRel(2.0 * 0.035728841, 1e-6));
    CHECK(difference["significant"] == false);
  }
}

TEST_CASE("comparison: nothing is a percentage of what may be zero", "[report]") {
  ComparedJson tight = compared_fit("before", 85.0, 0.0);
  Json json = comparison_json({tight, compared_fit("after", 85.0, 0.3)}, {});
  const Json& leak = json["parameters"][2]["differences"][1];
  CHECK(leak["percent"].is_null());
  CHECK(leak["significant"] == true);
  CHECK_THAT(comparison_text(json, {}), Contains("+0.3 significant p"));
  CHECK_THAT(reason_of(comparison_headline(json), 0),
             Contains("leakage_coefficient differs in after by +0.3 (p"));
  // The first value is not zero, but its interval includes zero: 0.03 would be +200 %.
  ComparedJson other = compared_fit("after", 87.0, 0.03);
  other.result["provenance"]["inputs"][1]["sha256"] = "before";
  json = comparison_json({compared_fit("before", 85.0, 0.01), other}, {});
  CHECK(json["parameters"][2]["differences"][1]["percent"].is_null());
  // Two standard errors compared with 3.5: the mass comes first, although neither can be tested.
  CHECK_THAT(reason_of(comparison_headline(json), 0),
             Contains("mass differs in after by +2.35 %, not tested"));
}

TEST_CASE("comparison: fits on a terminal of 80 columns", "[report]") {
  const Json json = comparison_json({compared_fit("before the seal change", 85.0, 0.3),
                                     compared_fit("after the seal change", 86.0, 0.4)},
                                    {});
  const std::string wide = comparison_text(json, {});
  CHECK_THAT(wide, Contains("before the seal change  2 after the seal"));
  const std::string text = comparison_text(json, {false, 80});
  CAPTURE(text);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    CHECK(text_width(std::string_view(text).substr(begin, end - begin)) <= 80);
    begin = end + 1;
  }
  CHECK_THAT(text, Contains("1 before the seal change") && Contains("2 after the seal change"));
}

TEST_CASE("comparison: fits to the same records are not independent", "[report]") {
  ComparedJson other = compared_fit("other", 90.0, 0.3);
  other.result["provenance"]["inputs"][1]["sha256"] = "one";
  const Json json = comparison_json({compared_fit("one", 85.0, 0.3), other}, {});
  const Json& difference = json["parameters"][0]["differences"][1];
  CHECK(difference["significant"].is_null());
  CHECK_THAT(difference["reason"].get<std::string>(), Contains("same data"));
  CHECK(json["records"].size() == 1);
  CHECK(json["records"][0]["in"] == Json::array({true, true}));
  CHECK(json["warnings"].dump().find("fitted to the same records") != std::string::npos);
}

TEST_CASE("comparison: errors of few degrees of freedom are judged by Student's t", "[report]") {
  const auto fit = [](const char* name, double mass_kg, double freedom) {
    ComparedJson compared = compared_fit(name, mass_kg, 0.3);
    compared.result["parameters"][0]["degrees_of_freedom"] = freedom;
    return compared;
  };
  // 2.5 errors: p = 0.012 for the normal distribution, 0.067 for t with 2 + 2 degrees of freedom.
  const double mass_kg = 85.0 + 2.5 * std::hypot(0.4, 0.4);
  const Json json = comparison_json({fit("before", 85.0, 2.0), fit("after", mass_kg, 2.0)}, {});
  const Json& difference = json["parameters"][0]["differences"][1];
  CHECK_THAT(difference["degrees_of_freedom"].get<double>(), WithinRel(4.0, 1e-12));
  CHECK_THAT(difference["p_value"].get<double>(), WithinRel(0.0667666, 1e-5));
  CHECK(json["parameters"][0]["estimates"][0]["degrees_of_freedom"] == 2.0);
}

TEST_CASE("comparison: a file without degrees of freedom has those of its intervals", "[report]") {
  ComparedJson old = compared_fit("before", 85.0, 0.3);
  Json& mass = old.result["parameters"][0];
  mass.erase("degrees_of_freedom");
  mass.erase("ci95_from");
  // With three degrees of freedom the quantile of t is 3.182446. A bound truncates the lower end.
  mass["ci95"] = {84.9, 85.0 + 3.182446305 * 0.4};
  const Json json = comparison_json({old, compared_fit("after", 86.0, 0.3)}, {});
  CHECK_THAT(json["parameters"][0]["estimates"][0]["degrees_of_freedom"].get<double>(),
             WithinRel(3.0, 1e-6));
  CHECK_THAT(json["warnings"].dump(), Contains("before: written by a version"));
  CHECK_THAT(json["warnings"].dump(), !Contains("after: written by a version"));
}

TEST_CASE("comparison: repeats that differ are said of the fit that warned of them", "[report]") {
  ComparedJson other = compared_fit("after", 86.0, 0.3);
  other.result["between_repeats"] = Json::parse(
      R"({"differ": true, "p": 1e-4, "ratio": 5.0, "parameters": ["mass"],
          "cause": "supply_pressure", "cause_sd": 0.01, "cause_explains": 0.9})");
  const Json json = comparison_json({compared_fit("before", 85.0, 0.3), other}, {});
  CHECK_THAT(json["warnings"].dump(),
             Contains("after: its repeats differ") && Contains("supply_pressure"));
  CHECK_THAT(json["warnings"].dump(), !Contains("before: its repeats differ"));
}

namespace {

/// A fit to one record that also scores another one. Both are among its inputs.
ComparedJson half(const std::string& name, double mass_kg, const std::string& fitted,
                  const std::string& scored) {
  ComparedJson compared = compared_fit(name, mass_kg, 0.3);
  compared.result["provenance"]["inputs"] = {{{"path", "a/one.csv"}, {"sha256", fitted}},
                                             {{"path", "a/two.csv"}, {"sha256", scored}}};
  Json& conditions = compared.result["conditions"];
  conditions.push_back(conditions[0]);
  conditions[0]["record_sha256"] = Json::array({fitted});
  conditions[1]["id"] = "scored";
  conditions[1]["use"] = "validate";
  conditions[1]["record_sha256"] = Json::array({scored});
  return compared;
}

bool is_tested(const ComparedJson& a, const ComparedJson& b) {
  const Json json = comparison_json({a, b}, {});
  const bool tested = json["parameters"][0]["differences"][1]["significant"].is_boolean();
  // Differences that are not tested cause a warning.
  CHECK(tested == (json["warnings"].dump().find("fitted to the same") == std::string::npos));
  return tested;
}

}  // namespace

TEST_CASE("comparison: halves that score each other's records are independent", "[report]") {
  const ComparedJson first = half("h1", 85.0, "one", "two");
  CHECK(is_tested(first, half("h2", 86.0, "two", "one")));
  CHECK_FALSE(is_tested(first, half("again", 86.0, "one", "two")));
  // Either result may come from an earlier version, which does not name the fitted records.
  ComparedJson old = half("old", 86.0, "two", "one");
  for (Json& condition : old.result["conditions"]) condition.erase("record_sha256");
  CHECK_FALSE(is_tested(first, old));
}

TEST_CASE("comparison: windows of one file that do not overlap are other samples", "[report]") {
  const auto within = [](const char* name, double low, double high) {
    ComparedJson compared = half(name, 85.0, "one", "two");
    compared.result["conditions"][0]["windows_s"] = Json::array({{low, high}});
    return compared;
  };
  const ComparedJson first = within("h1", 0.0, 10.0);
  CHECK(is_tested(first, within("h2", 10.0, 20.0)));
  CHECK_FALSE(is_tested(first, within("h2", 9.0, 20.0)));
  ComparedJson whole = half("whole", 85.0, "one", "two");
  CHECK_FALSE(is_tested(first, whole));
}

TEST_CASE("comparison: a failed fit has no values, and two usable ones are needed", "[report]") {
  ComparedJson failed = compared_fit("failed", 85.0, 0.3);
  failed.result["status"] = "failed";
  failed.result["message"] = "no start could be simulated";
  const Json json = comparison_json({compared_fit("good", 85.0, 0.3), failed}, {});
  CHECK(json["status"] == "failed");
  CHECK(json["parameters"][0]["estimates"][1]["value"].is_null());
  CHECK(json["conditions"][0]["scores"][1]["rho2"].is_null());
  CHECK(json["parameters"][0]["differences"][1]["reason"] == "one has no value");
  CHECK_THAT(comparison_text(json, {}), Contains("failed: no start could be simulated"));
}

TEST_CASE("comparison: the leak's trend along dates", "[report]") {
  const Json json =
      comparison_json({compared_fit("a", 85.0, 0.30, 0), compared_fit("b", 85.0, 0.34, 4),
                       compared_fit("c", 85.0, 0.40, 10), compared_fit("d", 85.0, 0.44, 14)},
                      {});
  const Json& along = json["leak_trends"][0]["along_date"];
  CHECK_THAT(along["slope_per_day"].get<double>(), WithinRel(0.01, 1e-9));
  CHECK(along["significant"] == true);
  CHECK(along["points"] == 4);
  const Json& warm = json["leak_trends"][0]["along_temperature"];
  CHECK(warm["slope_per_k"].is_null());
  CHECK_THAT(warm["reason"].get<std::string>(), Contains("same date or temperature"));
  // 2026-03-01 is day 20513 since 1970-01-01.
  CHECK(json["leak_trends"][0]["points"][0]["day"] == 20513.0);
}

TEST_CASE("comparison: a leak is of the days on which its own conditions were fitted", "[report]") {
  std::vector<ComparedJson> results{compared_fit("a", 85.0, 0.30, 0),
                                    compared_fit("b", 85.0, 0.34, 4),
                                    compared_fit("c", 85.0, 0.40, 10)};
  for (ComparedJson& each : results) {
    Json other = each.result["conditions"][0];
    other["date"] = "2020-01-01";
    other["id"] = "validated";
    other["use"] = "validate";
    each.result["conditions"].push_back(other);
    Json& leakage = each.result["parameters"][2];
    leakage["scope"] = "leak_level";
    leakage["level"] = "none";
    other["id"] = "leaking";
    other["use"] = "fit";
    other["leak_level"] = "33 %";
    each.result["conditions"].push_back(other);
  }
  const Json json = comparison_json(results, {});
  CHECK(json["leak_trends"][0]["points"][0]["day"] == 20513.0);
  CHECK(json["leak_trends"][0]["along_date"]["points"] == 3);
}

TEST_CASE("comparison: scores over the conditions that both have", "[report]") {
  ComparedJson worse = compared_fit("worse", 85.0, 0.3);
  worse.result["conditions"][0]["metrics"]["position"]["rho2"] = 0.9;
  Json extra = worse.result["conditions"][0];
  extra["id"] = "only here";
  worse.result["conditions"].push_back(extra);
  const Json json = comparison_json({compared_fit("good", 85.0, 0.3), worse}, {});
  const Json& rho2 = json["metrics"][0]["against_first"][1];
  CHECK(json["metrics"][0]["metric"] == "rho2");
  CHECK(rho2["conditions"] == 1);
  CHECK(rho2["worse"] == 1);
  CHECK(rho2["mean"] == 0.9);
  CHECK(rho2["mean_of_first"] == 0.99876543);
  // The sign in a single condition proves nothing.
  CHECK(rho2["p_value"].is_null());
  CHECK(rho2["significant"].is_null());
  CHECK(rho2["reason"] == "not tested: 1 condition, and a sign test needs 6");
  CHECK_THAT(comparison_text(json, {}), Contains("not\n  tested") || Contains("not tested"));
  CHECK(json["conditions"][1]["scores"][0].is_null());
}

TEST_CASE("comparison: a sign test needs six conditions, of records of their own", "[report]") {
  ComparedJson good = compared_fit("good", 85.0, 0.3);
  for (int i = 0; i < 5; ++i) {
    Json extra = good.result["conditions"][0];
    extra["id"] = "c" + std::to_string(i);
    good.result["conditions"].push_back(extra);
  }
  ComparedJson worse = good;
  worse.name = "worse";
  worse.result["provenance"]["inputs"][1]["sha256"] = "worse";
  for (Json& condition : worse.result["conditions"]) condition["metrics"]["position"]["rho2"] = 0.9;
  Json json = comparison_json({good, worse}, {});
  Json rho2 = json["metrics"][0]["against_first"][1];
  CHECK(rho2["p_value"] == 0.03125);  // 2 / 2^6
  CHECK(rho2["significant"] == true);
  CHECK(rho2["reason"].is_null());
  // A tie does not count for either result.
  ComparedJson tied = worse;
  tied.result["conditions"][0]["metrics"]["position"]["rho2"] = 0.99876543;
  const Json of_five = comparison_json({good, tied}, {})["metrics"][0]["against_first"][1];
  CHECK(of_five["conditions"] == 6);
  CHECK(of_five["worse"] == 5);
  CHECK(of_five["better"] == 0);
  CHECK(of_five["reason"] == "not tested: 5 conditions, and a sign test needs 6");
  worse.result["provenance"]["inputs"] = good.result["provenance"]["inputs"];
  json = comparison_json({good, worse}, {});
  rho2 = json["metrics"][0]["against_first"][1];
  CHECK(rho2["worse"] == 6);
  CHECK(rho2["p_value"].is_null());
  CHECK_THAT(rho2["reason"].get<std::string>(), Contains("share records"));
}

TEST_CASE("comparison: what was not tested is not called insignificant", "[report]") {
  ComparedJson other = compared_fit("other", 90.0, 0.15);
  other.result["provenance"]["inputs"][1]["sha256"] = "one";
  const Json json = comparison_json({compared_fit("one", 85.0, 0.3), other}, {});
  const Json& found = json["significance"][1];
  CHECK(json["significance"][0].is_null());
  CHECK(found["compared"] == 2);  // the third parameter is known in both
  CHECK(found["tested"] == 0);
  CHECK(found["text"] ==
        "2 parameters compared, 0 tested; not tested: mass, leakage_coefficient, because estimated "
        "from the same data, so not independent of each other");
  CHECK_THAT(comparison_text(json, {}), Contains("-50 % not tested"));
  const auto headline = comparison_headline(json);
  CHECK(headline.badge.words == "COMPARED");
  CHECK(sentence_of(headline) ==
        "2 results, 2 parameter differences; none could be tested for significance.");
  // The largest comes first.
  CHECK_THAT(reason_of(headline, 0),
             Contains("leakage_coefficient differs in other by -50 %, not tested: estimated from"));
  CHECK_THAT(reason_of(headline, 1), Contains("mass differs in other"));
}

TEST_CASE("comparison: what was tested is counted", "[report]") {
  ComparedJson after = compared_fit("after", 85.1, 0.6);
  const Json none =
      comparison_json({compared_fit("before", 85.0, 0.3), compared_fit("after", 85.1, 0.3)}, {});
  CHECK(none["significance"][1]["text"] ==
        "2 parameters compared, 2 tested, no significant difference");
  CHECK(comparison_headline(none).reasons.empty());
  after.result["parameters"][0]["standard_error"] = nullptr;
  after.result["parameters"][0]["robust_standard_error"] = nullptr;
  const Json json = comparison_json({compared_fit("before", 85.0, 0.3), after}, {});
  CHECK(json["significance"][1]["text"] ==
        "2 parameters compared, 1 tested, 1 significant difference; not tested: mass, because an "
        "estimate has no standard error");
  const auto headline = comparison_headline(json);
  CHECK(headline.badge.words == "DIFFERENT");
  CHECK(sentence_of(headline) ==
        "2 results, 2 parameter differences: 1 tested, 1 significant, 1 not tested.");
  CHECK_THAT(reason_of(headline, 0), Contains("leakage_coefficient differs in after by +100 % (p"));
  CHECK_THAT(reason_of(headline, 1), Contains("not tested"));
}

TEST_CASE("comparison: a trend of results that share records is not tested", "[report]") {
  std::vector<ComparedJson> results{compared_fit("a", 85.0, 0.30, 0),
                                    compared_fit("b", 85.0, 0.34, 4),
                                    compared_fit("c", 85.0, 0.40, 10)};
  CHECK(comparison_json(results, {})["leak_trends"][0]["along_date"]["reason"].is_null());
  results[2].result["provenance"]["inputs"] = results[1].result["provenance"]["inputs"];
  const Json json = comparison_json(results, {});
  const Json& along = json["leak_trends"][0]["along_date"];
  CHECK(along["p_value"].is_null());
  CHECK_THAT(along["reason"].get<std::string>(), Contains("share records"));
}

TEST_CASE("comparison: fits to published tables, which have no records", "[report]") {
  const auto tables_fit = [](const std::string& name, double mass_kg, const std::string& number) {
    ComparedJson fit = compared_fit(name, mass_kg, 0.3);
    fit.result["of"] = "published tables";
    fit.result["conditions"] = Json::array();
    fit.result["provenance"]["inputs"] = Json::array();
    fit.result["residuals"] = {{{"of", number}, {"weight", 1.0}, {"log_ratio", 0.0}}};
    fit.result.erase("synthetic");
    fit.result["left_out"] = Json::array();
    fit.result["rms"] = 0.01;
    fit.result["iterations"] = 3;
    return fit;
  };
  Json json = comparison_json({tables_fit("a", 85.0, "C"), tables_fit("b", 90.0, "C")}, {});
  CHECK(json["results"][0]["conditions"] == 0);
  CHECK(json["results"][0]["synthetic"] == false);
  CHECK_THAT(json["parameters"][0]["differences"][1]["reason"].get<std::string>(),
             Contains("same data"));
  CHECK_THAT(json["warnings"].dump(), Contains("fitted to the same published numbers"));
  json = comparison_json({tables_fit("a", 85.0, "C"), tables_fit("b", 90.0, "other")}, {});
  CHECK(json["parameters"][0]["differences"][1]["significant"] == true);
}

TEST_CASE("comparison: names the file that is no result of this version", "[report]") {
  ComparedJson broken = compared_fit("broken", 85.0, 0.3);
  broken.result.erase("conditions");
  CHECK_THROWS_WITH(comparison_json({compared_fit("good", 85.0, 0.3), broken}, {}),
                    Contains("broken/fit.json") && Contains("conditions"));
}
