#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// kCampaign with an additional line in [fit].
Edits with_fit(const std::string& line) {
  return {{"[acceptance]", "[fit]\n" + line + "\n[acceptance]"}};
}

json parameters_of(const CommandFolder& folder, const std::string& out) {
  return json::parse(folder.read(out + "/fit.json")).at("parameters");
}

}  // namespace

TEST_CASE("fit: multiple shooting leads to the same values, whatever the threads", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "single", "--quiet"}).exit_code == 0);
  folder.write("twin/shooting.toml", edited(folder.read("twin/campaign.toml"),
                                            with_fit("shooting_interval = \"0.2 s\"")));
  for (const std::string threads : {"1", "3"}) {
    const Outcome fitted = folder.run({"fit", "twin/shooting.toml", "--threads", threads, "--out",
                                       "shooting" + threads, "--quiet"});
    CHECK(fitted.err.empty());
    REQUIRE(fitted.exit_code == 0);
  }
  CHECK(parameters_of(folder, "shooting1") == parameters_of(folder, "shooting3"));
  // The file with the fitted values keeps the other keys of the campaign.
  CHECK_THAT(folder.read("shooting1/fitted.toml"), Contains("shooting_interval"));
  const json single = parameters_of(folder, "single");
  const json shooting = parameters_of(folder, "shooting1");
  REQUIRE(single.size() == shooting.size());
  int compared = 0;
  for (std::size_t j = 0; j < single.size(); ++j) {
    if (!single[j].at("fitted").get<bool>()) continue;
    ++compared;
    const double error = single[j].at("standard_error").get<double>();
    CHECK(shooting[j].at("value").get<double>() ==
          Approx(single[j].at("value").get<double>()).margin(0.02 * error).epsilon(0.0));
  }
  CHECK(compared == 2);
}

TEST_CASE("fit: a shooting_interval that makes no sense is refused", "[apps]") {
  const CommandFolder folder;
  struct Bad {
    std::string line;
    std::string found;
  };
  for (const Bad& bad : {Bad{"shooting_interval = 0.5", "expected"},
                         Bad{"shooting_interval = \"0.5 m\"", "expected"},
                         Bad{"shooting_interval = \"0 s\"", "expected"},
                         Bad{"shooting_interval = \"-1 s\"", "expected"},
                         Bad{"shooting_intervall = \"1 s\"", "shooting_interval"}}) {
    CAPTURE(bad.line);
    write_campaign(folder, with_fit(bad.line));
    const Outcome refused = folder.run({"fit", "campaign.toml"});
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, Contains("campaign.toml:29:") && Contains(bad.found));
    CHECK_FALSE(folder.has("rigcal-out/fit.json"));
  }
  // Records with a sampling interval of 5 ms.
  write_campaign(folder, with_fit("shooting_interval = \"10 ms\""));
  const Outcome dense = folder.run({"fit", "campaign.toml"});
  CHECK(dense.exit_code == 2);
  CHECK_THAT(dense.err, Contains("campaign.toml:") && Contains("\"sine\"") &&
                            Contains("fewer than 4 samples"));
  CHECK_FALSE(folder.has("rigcal-out/fit.json"));
}
