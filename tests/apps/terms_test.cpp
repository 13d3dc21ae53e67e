// Tests rigs with single terms through the command line: records of a known rig, and the fit that
// finds its values again.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/two_chamber_fixture.hpp"

namespace rigcal::test {
namespace {

/// Fits the records in `twin/` and checks that the estimates of some parameters are near their
/// true values, known to at least one part in a hundred.
void check_recovery(const CommandFolder& folder,
                    const std::vector<std::pair<std::string, double>>& truth) {
  const Outcome outcome = folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--quiet"});
  INFO(outcome.err);
  REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
  const auto fit = nlohmann::json::parse(folder.read("fit/fit.json"));
  REQUIRE(fit["status"].get<std::string>() == "converged");
  for (const auto& [key, value] : truth) {
    const auto found = std::find_if(
        fit["parameters"].begin(), fit["parameters"].end(),
        [&](const nlohmann::json& each) { return each["key"].get<std::string>() == key; });
    REQUIRE(found != fit["parameters"].end());
    const double estimate = (*found)["value"].get<double>();
    const double error = (*found)["standard_error"].get<double>();
    CAPTURE(key, estimate, error);
    CHECK(std::abs(estimate - value) < 3.5 * error);
    CHECK(error < 0.01 * std::abs(value));
  }
}

}  // namespace

TEST_CASE("terms: a fit finds the main spool of a two-stage valve", "[apps]") {
  const CommandFolder folder;
  const std::string campaign =
      edited(kTwoChamber, {{"leakage_coefficient = 0\n",
                            "leakage_coefficient = 0\nvalve_time_constant = \"3 ms\"\n"
                            "main_spool_gain = { start = \"40 1/s\", lower = \"10 1/s\", upper = "
                            "\"500 1/s\", fit = true }\n"}});
  const std::string truth = edited(
      kTwoChamberTruth, {{"mass = \"5 kg\"", "mass = \"5 kg\", main_spool_gain = \"90 1/s\""}});
  const Outcome twin = synthesize_twin(folder, campaign + truth);
  INFO(twin.err);
  REQUIRE(twin.exit_code == 0);
  check_recovery(folder, {{"main_spool_gain", 90.0}, {"valve_gain", 4e-6}});
}

}  // namespace rigcal::test
