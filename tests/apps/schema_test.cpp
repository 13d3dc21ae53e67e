#include "tests/apps/schema.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <valijson/utils/nlohmann_json_utils.hpp>

#include "tests/apps/cli_fixture.hpp"
#include "tests/support/violations.hpp"

using nlohmann::json;
using rigcal::test::CommandFolder;
using rigcal::test::violations;
using rigcal::test::write_twin;

std::string rigcal::test::violations(const json& document, const std::string& name) {
  json rules;
  const std::string file = std::string(RIGCAL_SOURCE_DIR) + "/docs/schema/" + name + ".schema.json";
  REQUIRE(valijson::utils::loadDocument(file, rules));
  return Rules(rules).violations(document);
}

TEST_CASE("schema: results of fits and validations, good and failed", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--profiles", "--bootstrap", "20",
              "--posterior", "100", "--cross-validate", "--starts", "2", "--quiet"});
  const json fit = json::parse(folder.read("fit/fit.json"));
  CHECK(violations(fit, "result") == "");
  folder.run(
      {"validate", "twin/campaign.toml", "--fit", "fit/fit.json", "--out", "val", "--quiet"});
  json scored = json::parse(folder.read("val/validation.json"));
  CHECK(violations(scored, "result").empty());
  // Nothing was estimated; a cost of zero would look like a perfect fit.
  CHECK(scored.at("cost").is_null());
  scored["cost"] = 0.0;
  CHECK_FALSE(violations(scored, "result").empty());
  folder.write("twin/hopeless.toml",
               folder.read("twin/campaign.toml") + "\n[simulation]\nmax_seconds = 1e-6\n");
  folder.run({"fit", "twin/hopeless.toml", "--out", "failed", "--quiet"});
  CHECK(violations(json::parse(folder.read("failed/fit.json")), "result").empty());

  REQUIRE(fit["parameters"][0].contains("identifiability"));
  REQUIRE(fit.contains("cross_validation"));
  // The page shows the additional findings of such a fit.
  const std::string page = folder.read("fit/report.html");
  for (const char* title :
       {"<h3>Profiles", "<h3>Bootstrap", "<h3>Posterior", "<h3>Lack of fit", "left out"})
    CHECK_THAT(page, Catch::Contains(title));

  // All draws are stored, together with what was derived from them.
  REQUIRE(fit["posterior"]["draws"] == 100);
  CHECK(fit["posterior"]["effects"] == true);
  CHECK(fit["parameters"][0].contains("posterior"));
  const std::string draws = folder.read("fit/posterior.csv");
  CHECK(draws.rfind("chain,draw,", 0) == 0);
  CHECK(std::count(draws.begin(), draws.end(), '\n') == 401);
  CHECK_THAT(page, Catch::Contains("Draws of ") && Catch::Contains("are drawn with the unknowns"));

  json broken = fit;
  broken["parameters"][0]["value"] = "60 kg";
  CHECK_FALSE(violations(broken, "result").empty());
  broken = fit;
  broken.erase("status");
  CHECK_FALSE(violations(broken, "result").empty());
  broken = fit;
  broken["of"] = "published tables";  // fits to published tables have other keys
  CHECK_FALSE(violations(broken, "result").empty());
}
