#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;

}  // namespace

TEST_CASE("plan: planned records are compared with those that exist", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string planned = R"(
[[condition]]
id = "planned_10Hz"
waveform = "square"
frequency = "10 Hz"
amplitude = "2 mm"
duration = "1 s"
sample_rate = "1 kHz"
leak_level = "none"
use = "fit"
)";
  folder.write("twin/plan.toml", folder.read("twin/campaign.toml") + planned);
  const Outcome outcome = folder.run({"plan", "twin/plan.toml", "--out", "out"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(folder.read("out/plan.json"));
  CHECK(violations(json, "plan") == "");
  REQUIRE(json["records"].size() == 3);
  CHECK(json["records"][2]["recorded"] == false);
  REQUIRE(json["parameters"].size() == 2);
  for (const auto& parameter : json["parameters"])
    CHECK(parameter["sd_all"].get<double>() < parameter["sd_recorded"].get<double>());
  CHECK_THAT(outcome.out, Contains("planned_10Hz (planned)"));
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("id=\"plan\"") && Contains("planned_10Hz (planned)") &&
                       Contains("fraction of the precision of all records"));
  CHECK(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
}

TEST_CASE("plan: of a condition that cannot be simulated nothing is known", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  folder.write("twin/plan.toml", folder.read("twin/campaign.toml") + R"(
[[condition]]
id = "runs_away"
waveform = "square"
frequency = "10 Hz"
amplitude = "2 mm"
duration = "1 s"
sample_rate = "1 kHz"
leak_level = "none"
use = "fit"
parameters = { load_curvature = "1e12 N/m2" }
)");
  const Outcome outcome = folder.run({"plan", "twin/plan.toml", "--out", "out"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(folder.read("out/plan.json"));
  CHECK(violations(json, "plan") == "");
  const auto& record = json["records"][2];
  CHECK_THAT(record["problem"].get<std::string>(), Contains("cannot be simulated"));
  CHECK(record["sd_alone"] == nlohmann::json({nullptr, nullptr}));
  CHECK(record["sd_without"] == record["sd_alone"]);
  CHECK(json["records"][0]["sd_alone"][0].is_number());
  CHECK_THAT(outcome.out, Contains("runs_away: cannot be simulated"));
  const std::string page = folder.read("out/report.html");
  CHECK(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
}

}  // namespace rigcal::test
