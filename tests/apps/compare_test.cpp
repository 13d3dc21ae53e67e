#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

TEST_CASE("compare: fits of two days, one with another valve", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "before", "--quiet"}).exit_code == 0);
  folder.write("other.toml", kCampaign + edited(kSynthetic, {{"\"3e-5 m/V\"", "\"2.5e-5 m/V\""}}));
  REQUIRE(folder.run({"synthesize", "other.toml", "--seed", "5", "--out", "other"}).exit_code == 0);
  REQUIRE(folder.run({"fit", "other/campaign.toml", "--out", "after", "--quiet"}).exit_code == 0);

  const Outcome outcome = folder.run({"compare", "before", "after", "--out", "both"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("valve_gain") && Contains("before") && Contains("after"));
  const json result = json::parse(folder.read("both/comparison.json"));
  CHECK(violations(result, "comparison") == "");
  bool found = false;
  for (const json& parameter : result["parameters"]) {
    if (parameter["key"] != "valve_gain") continue;
    found = true;
    const json fit = json::parse(folder.read("before/fit.json"));
    for (const json& p : fit["parameters"]) {
      if (p["key"] == "valve_gain") CHECK(parameter["estimates"][0]["value"] == p["value"]);
    }
    // 3e-5 compared with 2.5e-5 m/V, at 0.01 mm of noise.
    CHECK(parameter["differences"][1]["significant"] == true);
    CHECK(parameter["differences"][1]["difference"].get<double>() < 0.0);
  }
  CHECK(found);
  const std::string page = folder.read("both/report.html");
  CHECK_THAT(page, Contains("<title>DIFFERENT") && Contains("id=\"estimates\""));
  REQUIRE(folder.run({"report", "both"}).exit_code == 0);
  CHECK(folder.read("both/report.html") == page);
}

TEST_CASE("compare: the same records with a term on and off", "[apps]") {
  const CommandFolder folder;
  // The true rig has friction; one of the fits does not include it.
  folder.write(
      "truth.toml",
      kCampaign + edited(kSynthetic, {{"damping = ", "coulomb_friction = \"60 N\", damping = "}}));
  REQUIRE(folder.run({"synthesize", "truth.toml", "--seed", "3", "--out", "twin"}).exit_code == 0);
  const std::string twin = folder.read("twin/campaign.toml");
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "without", "--quiet"}).exit_code == 0);
  const std::string given = "[rig.parameters]\n";
  folder.write(
      "twin/friction.toml",
      edited(twin, {{given, given + "coulomb_friction = { start = \"20 N\", lower = \"0 N\", "
                                    "upper = \"500 N\", fit = true }\n"}}));
  REQUIRE(folder.run({"fit", "twin/friction.toml", "--out", "with", "--quiet"}).exit_code == 0);

  const Outcome outcome = folder.run({"compare", "without", "with", "--out", "both"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("with is preferred") && Contains("load_pressure"));
  const json result = json::parse(folder.read("both/comparison.json"));
  CHECK(violations(result, "comparison") == "");
  CHECK(result["results"][1]["model"] == "load_pressure");
  const json& choice = result["models"][1];
  CHECK(choice["smaller"] == "without");
  CHECK(choice["freedom"] == 1);
  CHECK(choice["p_value"].get<double>() < 1e-3);
  CHECK(choice["delta_aic"].get<double>() < 0.0);
  CHECK_THAT(folder.read("both/report.html"), Contains("id=\"models\""));
}

TEST_CASE("compare: halves of a campaign are tested by what fit writes", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string campaign = folder.read("twin/campaign.toml");
  folder.write("twin/swapped.toml", edited(campaign, {{"use = \"fit\"", "use = \"later\""},
                                                      {"use = \"validate\"", "use = \"fit\""},
                                                      {"use = \"later\"", "use = \"validate\""}}));
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "one", "--quiet"}).exit_code < 2);
  REQUIRE(folder.run({"fit", "twin/swapped.toml", "--out", "two", "--quiet"}).exit_code < 2);
  // Without these, a comparison takes independence and a normal distribution for granted.
  for (const char* name : {"one/fit.json", "two/fit.json"}) {
    const json fit = json::parse(folder.read(name));
    int fitted = 0;
    for (const json& parameter : fit["parameters"]) {
      if (!parameter["fitted"].get<bool>()) continue;
      ++fitted;
      REQUIRE(parameter["degrees_of_freedom"].is_number());
      CHECK(parameter["degrees_of_freedom"].get<double>() >= 1.0);
    }
    CHECK(fitted == 2);
    REQUIRE(fit["conditions"].size() == 2);
    for (const json& condition : fit["conditions"]) CHECK(condition["record_sha256"].size() == 3);
  }
  REQUIRE(folder.run({"compare", "one", "two", "--out", "both", "--quiet"}).exit_code == 0);
  const json result = json::parse(folder.read("both/comparison.json"));
  int tested = 0;
  for (const json& parameter : result["parameters"]) {
    if (parameter["key"] != "valve_gain" && parameter["key"] != "damping") continue;
    ++tested;
    CHECK(parameter["differences"][1]["significant"].is_boolean());
  }
  CHECK(tested == 2);
}

TEST_CASE("compare: what it refuses", "[apps]") {
  const CommandFolder folder;
  folder.write("empty/note.txt", "");
  Outcome outcome = folder.run({"compare", "empty"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("two result folders"));
  outcome = folder.run({"compare", "empty", "./empty/"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("given twice"));
  folder.write("bare/note.txt", "");
  outcome = folder.run({"compare", "empty", "bare"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("neither fit.json nor validation.json"));
  CHECK_FALSE(folder.has("rigcal-out"));
}
