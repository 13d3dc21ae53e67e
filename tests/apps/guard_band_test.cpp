#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/cli_fixture.hpp"

// A decision rule as an engineer specifies it, from the campaign file to the exit code.

namespace rigcal::test {
namespace {

using Json = nlohmann::json;

Json result_of(const CommandFolder& folder, const std::string& file) {
  return Json::parse(folder.read(file));
}

/// kCampaign with a separate limit for the score of the sine.
Edits with_limit(double limit, const std::string& decision) {
  return {{"rho2 = 0.9\n", fmt::format("rho2 = {:.17g}\n{}", limit, decision)}};
}

}  // namespace

TEST_CASE("fit: by the guard band a limit is kept by more than the score's uncertainty", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "plain", "--quiet"}).exit_code == 0);
  const Json plain = result_of(folder, "plain/fit.json");
  CHECK(plain["decision"] == "simple");
  CHECK(folder.read("plain/report.html").find("Decision rule: simple acceptance") !=
        std::string::npos);
  // The lowest score decides; the limit is placed so that this score is in its guard band.
  double rho2 = 1.0;
  double uncertainty = 0.0;
  for (const Json& condition : plain["conditions"]) {
    const double score = condition["metrics"]["position"]["rho2"];
    REQUIRE(condition["expanded_uncertainty"]["position"]["rho2"] > 0.0);
    if (score >= rho2) continue;
    rho2 = score;
    uncertainty = condition["expanded_uncertainty"]["position"]["rho2"];
  }
  const std::string text = folder.read("twin/campaign.toml");
  const auto judged = [&](double limit, const std::string& decision) {
    folder.write("twin/judged.toml", edited(text, with_limit(limit, decision)));
    return folder.run({"fit", "twin/judged.toml", "--out", "judged", "--strict"});
  };
  const std::string guard = "decision = \"guard_band\"\n";

  const Outcome simple = judged(rho2 - 0.5 * uncertainty, "");
  CHECK(simple.exit_code == 0);
  CHECK_THAT(simple.out,
             Catch::StartsWith("PASS: ") && Catch::Contains("Decision rule: simple acceptance"));
  CHECK(judged(rho2 - 1.5 * uncertainty, guard).exit_code == 0);
  const Outcome within = judged(rho2 - 0.5 * uncertainty, guard);
  CHECK(within.exit_code == 1);
  CHECK_THAT(within.out,
             Catch::StartsWith("WARN: ") && Catch::Contains("Decision rule: guard band"));
  CHECK_THAT(within.out, Catch::Contains("not by more than its expanded uncertainty"));
  const Json result = result_of(folder, "judged/fit.json");
  CHECK(result["verdict"] == "WARN");
  CHECK(result["decision"] == "guard_band");
  const Json& reasons = result["assessment"]["agreement"]["reasons"];
  CHECK(std::any_of(reasons.begin(), reasons.end(),
                    [](const Json& reason) { return reason["code"] == "guard_band"; }));
  CHECK(folder.read("judged/report.html").find("Decision rule: guard band") != std::string::npos);

  // A validation with single recordings cannot determine the uncertainty.
  folder.write("twin/one.toml",
               edited(text, {{"rho2 = 0.9\n", "rho2 = 0.9\n" + guard},
                             {R"(, "records/sine_r2.csv", "records/sine_r3.csv")", ""},
                             {R"(, "records/square_r2.csv", "records/square_r3.csv")", ""}}));
  const Outcome one =
      folder.run({"validate", "twin/one.toml", "--fit", "plain/fit.json", "--out", "one"});
  CHECK(one.exit_code == 0);
  CHECK_THAT(one.out, Catch::Contains("its uncertainty is unknown"));
  CHECK(result_of(folder, "one/validation.json")["verdict"] == "WARN");
}

TEST_CASE("fit: what a certificate states of a sensor counts, or is told", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string text = folder.read("twin/campaign.toml");
  const auto judged = [&](const std::string& sensor, const Edits& more = {}) {
    folder.write(
        "twin/judged.toml",
        edited(edited(text, {{"rho2 = 0.9\n", "rho2 = 0.9\ndecision = \"guard_band\"\n"}}), more) +
            "\n[[report.sensor]]\nchannel = \"position\"\n" + sensor);
    return folder.run({"fit", "twin/judged.toml", "--out", "judged", "--strict"});
  };
  const auto uncertainty = [&](const char* condition) {
    const Json result = result_of(folder, "judged/fit.json");
    for (const Json& each : result["conditions"]) {
      if (each["id"] == condition)
        return each["expanded_uncertainty"]["position"]["rho2"].get<double>();
    }
    return 0.0;
  };
  CHECK(judged("uncertainty = \"0.002 mm (k = 2)\"\n").exit_code == 0);
  const double small = uncertainty("sine");
  // The uncertainty is as large as the motion, so that no limit is met with the guard band.
  const Outcome large = judged("uncertainty = \"20 mm (k = 2)\"\n");
  CHECK(large.exit_code == 1);
  CHECK_THAT(large.out,
             Catch::StartsWith("WARN: ") && Catch::Contains("Decision rule: guard band"));
  CHECK(uncertainty("sine") > 100.0 * small);

  const Outcome other = judged("uncertainty = \"class 0.1\"\n");
  CHECK(other.exit_code == 1);
  CHECK_THAT(other.out, Catch::Contains("\"class 0.1\", is not used"));
  CHECK_THAT(folder.run({"check", "twin/judged.toml"}).out,
             Catch::Contains("warning: the uncertainty of the sensor of position"));

  const std::string dates = "calibrated = 2024-01-31\ndue = 2025-01-31\n";
  CHECK(judged(dates).exit_code == 0);  // the campaign does not give the dates of the tests
  const Edits tested{{"use = \"validate\"", "use = \"validate\"\ndate = 2026-02-26"}};
  const Outcome overdue = judged(dates, tested);
  CHECK(overdue.exit_code == 1);
  CHECK_THAT(overdue.out, Catch::Contains("was due for calibration on 2025-01-31"));
  CHECK_THAT(folder.read("judged/report.html"), Catch::Contains("square was tested on 2026-02-26"));
  CHECK_THAT(folder.run({"check", "twin/judged.toml"}).out,
             Catch::Contains("warning: the sensor of position was due"));
  CHECK_THAT(judged("calibrated = 2024-01-31\ndue = 2023-01-31\n").out,
             Catch::Contains("before it was"));
}

TEST_CASE("fit: a channel that is compared and not judged is a reservation", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string text = folder.read("twin/campaign.toml");
  const auto csv_verdict = [&](const std::string& channel) {
    const std::string csv = folder.read("out/scorecard.csv");
    const auto end = csv.find("," + channel + ",");
    REQUIRE(end != std::string::npos);
    return csv.substr(csv.rfind(',', end - 1) + 1, end - csv.rfind(',', end - 1) - 1);
  };
  const std::vector<std::string> fit{"fit", "twin/campaign.toml", "--out", "out", "--strict"};
  const Outcome stated = folder.run(fit);
  CHECK(stated.exit_code == 0);
  CHECK_THAT(stated.out, Catch::Contains("load_pressure is not judged in 2 conditions"));
  CHECK(csv_verdict("position") == "PASS");
  CHECK(csv_verdict("load_pressure") == "not judged");
  CHECK(result_of(folder, "out/fit.json")["not_judged"] == Json{"load_pressure"});
  CHECK_THAT(folder.read("out/report.html"), Catch::Contains("load_pressure is not judged in"));

  folder.write("twin/campaign.toml", edited(text, {{"not_judged = [\"load_pressure\"]\n", ""}}));
  const Outcome silent = folder.run(fit);
  CHECK(silent.exit_code == 1);
  CHECK_THAT(silent.out, Catch::StartsWith("WARN: ") &&
                             Catch::Contains("no limit applies to load_pressure in 2 conditions"));
  CHECK_FALSE(result_of(folder, "out/fit.json").contains("not_judged"));
  // A comparison marks only judged scores as passed.
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "two", "--quiet"}).exit_code == 0);
  REQUIRE(folder.run({"compare", "out", "two", "--out", "both", "--quiet"}).exit_code == 0);
  const Json compared = result_of(folder, "both/comparison.json");
  for (const Json& each : compared["conditions"]) {
    CAPTURE(each["id"], each["channel"]);
    const Json& verdict = each["scores"][0]["verdict"];
    if (each["channel"] == "position") CHECK(verdict == "PASS");
    if (each["channel"] == "load_pressure") CHECK(verdict.is_null());
  }

  folder.write("twin/campaign.toml", edited(text, {{"not_judged = [\"load_pressure\"]\n",
                                                    "[acceptance.load_pressure]\nrho2 = 0.5\n"}}));
  CHECK(folder.run(fit).exit_code == 0);
  CHECK(csv_verdict("load_pressure") == "PASS");
}

}  // namespace rigcal::test
