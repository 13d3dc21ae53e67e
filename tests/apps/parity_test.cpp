#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

using namespace rigcal::test;
using Catch::Contains;
using Catch::StartsWith;
using nlohmann::json;

namespace {

/// A healthy sine that is fitted, the same signal on another day, and one with a leak.
const std::string kWatched = edited(
    kCampaign, {{"leakage_coefficient = 0.3", "leakage_coefficient = 0"},
                {"[leak_level.\"none\"]",
                 "[leak_level.\"none\"]\nparameters = { leakage_coefficient = 0 }\n"
                 "[leak_level.\"open\"]\nparameters = { leakage_coefficient = 0.15 }\n"},
                {"id = \"square\"\nwaveform = \"square\"\nfrequency = \"1 Hz\"\n"
                 "amplitude = \"4 mm\"\nleak_level = \"none\"\nuse = \"validate\"\n"
                 "repeats = [\"records/square_*.csv\"]",
                 "id = \"later\"\nwaveform = \"sine\"\nfrequency = \"2 Hz\"\namplitude = \"5 mm\"\n"
                 "leak_level = \"none\"\nuse = \"validate\"\n"
                 "[[condition]]\nid = \"leaking\"\nwaveform = \"sine\"\nfrequency = \"2 Hz\"\n"
                 "amplitude = \"5 mm\"\nleak_level = \"open\"\nuse = \"diagnose\"\n"}});

void make_fit(const CommandFolder& folder) {
  folder.write("campaign.toml", kWatched + edited(kSynthetic, {{"repeats = 3", "repeats = 4"}}));
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made"}).exit_code ==
          0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit"}).exit_code == 0);
}

}  // namespace

TEST_CASE("parity: from records to an alarm, and back from the files", "[apps]") {
  const CommandFolder folder;
  make_fit(folder);
  const Outcome outcome =
      folder.run({"parity", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "parity"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("leaking") && Contains("alarm in 4 of 4 records") &&
                              Contains("reference") && Contains("expected)"));
  const json result = json::parse(folder.read("parity/parity.json"));
  CHECK(violations(result, "parity") == "");
  REQUIRE(result["records"].size() == 12);
  for (const json& record : result["records"]) {
    CAPTURE(record.dump());
    CHECK(record["healthy"] == (record["condition"] != "leaking"));
    CHECK(record["sets_threshold"] == (record["condition"] == "sine"));
    if (record["condition"] == "sine") CHECK(record["alarm"].is_null());
    if (record["condition"] == "leaking") {
      CHECK(record["alarm"] == true);
      CHECK(record["exceeds"]["rms_m"] == true);
      CHECK(record["time_to_alarm_s"].get<double>() < 0.5);
    }
  }
  CHECK(result["false_alarm_check"]["records"] == 4);
  CHECK_THAT(folder.read("parity/parity.csv"), StartsWith("condition,repeat,signal,"));
  CHECK_THAT(folder.read("parity/parity/leaking.csv"),
             StartsWith("time_s,healthy_model_m,parity_1_m,residual_1_m,moving_rms_1_m,"));
  const std::string page = folder.read("parity/report.html");
  CHECK_THAT(page, Contains("<title>ALARM") && Contains("id=\"parity\"") &&
                       Contains("Moving root mean square of leaking"));
  REQUIRE(folder.run({"report", "parity", "--figures"}).exit_code == 0);
  CHECK(folder.read("parity/report.html") == page);
  CHECK(folder.has("parity/figures/leaking_alarm.svg"));
}

TEST_CASE("parity: what is asked must make sense", "[apps]") {
  const CommandFolder folder;
  make_fit(folder);
  Outcome outcome = folder.run({"parity", "made/campaign.toml"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("--fit is missing"));
  for (const char* rate : {"0", "-1", "50", "nan"}) {
    CAPTURE(rate);
    outcome = folder.run(
        {"parity", "made/campaign.toml", "--fit", "fit/fit.json", "--false-alarms", rate});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("expected a percentage above 0 and below 50"));
  }
  outcome =
      folder.run({"parity", "made/campaign.toml", "--fit", "fit/fit.json", "--healthy", "closed"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("unknown leak level 'closed'"));
  CHECK_FALSE(folder.has("rigcal-out"));
}
