#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/apps/cli_fixture.hpp"

// A decision rule as an engineer states it, from the campaign file to the exit code.

namespace rigcal::test {
namespace {

using Json = nlohmann::json;

Json result_of(const CommandFolder& folder, const std::string& file) {
  return Json::parse(folder.read(file));
}

/// kCampaign with a limit of its own for the score of the sine.
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
  // The lowest score decides; its limit is set into its guard band.
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
  CHECK_THAT(simple.out, Catch::StartsWith("verdict: PASS by simple acceptance"));
  CHECK(judged(rho2 - 1.5 * uncertainty, guard).exit_code == 0);
  const Outcome within = judged(rho2 - 0.5 * uncertainty, guard);
  CHECK(within.exit_code == 1);
  CHECK_THAT(within.out, Catch::StartsWith("verdict: WARN by guard band"));
  CHECK_THAT(within.out, Catch::Contains("not by more than its expanded uncertainty"));
  const Json result = result_of(folder, "judged/fit.json");
  CHECK(result["verdict"] == "WARN");
  CHECK(result["decision"] == "guard_band");
  const Json& reasons = result["assessment"]["agreement"]["reasons"];
  CHECK(std::any_of(reasons.begin(), reasons.end(),
                    [](const Json& reason) { return reason["code"] == "guard_band"; }));
  CHECK(folder.read("judged/report.html").find("Decision rule: guard band") != std::string::npos);

  // A validation of single recordings cannot know.
  folder.write("twin/one.toml",
               edited(text, {{"rho2 = 0.9\n", "rho2 = 0.9\n" + guard},
                             {R"(, "records/sine_r2.csv", "records/sine_r3.csv")", ""},
                             {R"(, "records/square_r2.csv", "records/square_r3.csv")", ""}}));
  const Outcome one =
      folder.run({"validate", "twin/one.toml", "--fit", "plain/fit.json", "--out", "one"});
  CHECK(one.exit_code == 0);
  CHECK_THAT(one.out, Catch::Contains("its uncertainty is not known"));
  CHECK(result_of(folder, "one/validation.json")["verdict"] == "WARN");
}

}  // namespace rigcal::test
