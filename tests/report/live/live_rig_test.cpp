#include "report/live/live_rig.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::report {
namespace {

datasets::Campaign uis() {
  return datasets::load_campaign(std::filesystem::path(RIGCAL_SOURCE_DIR) /
                                 "datasets/rigs/uis_shake_table/campaign.toml");
}

const Json& parameter(const Json& rig, const std::string& key) {
  for (const Json& row : rig.at("parameters"))
    if (row.at("key") == key) return row;
  throw std::out_of_range(key);
}

TEST_CASE("live rig: the leak table with its assumptions, then the conditions", "[report][live]") {
  const datasets::Campaign campaign = uis();
  const auto cases = live_cases(campaign);
  REQUIRE(cases.size() == 6 + campaign.conditions.size());
  CHECK(cases.front().name == "leak table: sine_0.1Hz");
  CHECK(cases.front().task.values["mass"] == 85.0);
  CHECK(cases.front().task.values["leakage_coefficient"] == 0.15);
  CHECK(cases.back().name == campaign.conditions.back().id);
  CHECK(cases.back().task.values["mass"] == 60.0);
  CHECK(cases.back().task.time_s.size() == 3001);
}

TEST_CASE("live rig: a loop on something else than position has no leak table", "[report][live]") {
  datasets::Campaign campaign = uis();
  campaign.rig.feedback = model::Feedback::acceleration;
  CHECK(live_cases(campaign).size() == campaign.conditions.size());
}

TEST_CASE("live rig: ranges are the bounds of the campaign, else around the value",
          "[report][live]") {
  const datasets::Campaign campaign = uis();
  const Json rig = live_rig(campaign, live_cases(campaign));
  const Json& mass = parameter(rig, "mass");
  CHECK(mass.at("group") == "estimates");
  CHECK(mass.at("slider") == Json{{"lower", 10.0}, {"upper", 500.0}, {"scale", "log"}});
  CHECK(mass.at("highest") == 500.0);
  const Json& kp = parameter(rig, "kp");
  CHECK(kp.at("group") == "controller");
  CHECK(kp.at("slider").at("upper") == 5.0 * 78.74);
  CHECK(parameter(rig, "leakage_coefficient").at("slider").at("scale") == "cubic");
  // A spring that does not exist has neither bounds nor a value to derive a range from.
  CHECK(parameter(rig, "stiffness").at("slider").is_null());
  CHECK(parameter(rig, "valve_gain").at("unit") == "µm/V");
}

TEST_CASE("live rig: the levels of the published table are the buttons", "[report][live]") {
  datasets::Campaign campaign = uis();
  const auto names = [&campaign] {
    std::vector<std::string> result;
    const Json rig = live_rig(campaign, live_cases(campaign));
    for (const Json& each : rig.at("presets")) result.push_back(each.at("name"));
    return result;
  };
  CHECK(names() == std::vector<std::string>{"Slight", "Medium", "Critical", "Super"});
}

TEST_CASE("live rig: the published table is there for its own rig and drive", "[report][live]") {
  const datasets::Campaign campaign = uis();
  std::vector<LiveCase> cases = live_cases(campaign);
  const Json rig = live_rig(campaign, cases);
  REQUIRE(rig.at("levels").size() == 5);
  const Json& slight = rig.at("levels")[1];
  CHECK(slight.at("name") == "Slight");
  CHECK(slight.at("coefficient") == 0.15);
  CHECK(slight.at("printed").at("mean") == Json{{"value", 0.0508}, {"left_out", false}});
  CHECK(slight.at("printed").at("std").at("left_out") == true);
  CHECK_THAT(slight.at("reason").get<std::string>(), Catch::Contains("printed std"));
  CHECK(rig.at("residual_scale") == 55.35);
  // With another drive, or with fitted values, the levels remain but the published values do not.
  cases.erase(cases.begin(), cases.begin() + 6);
  const Json other = live_rig(campaign, cases);
  REQUIRE(other.at("levels").size() == 5);
  CHECK(other.at("levels")[1].at("printed").empty());
  CHECK_FALSE(other.contains("residual_scale"));
}

TEST_CASE("live rig: where nothing can be simulated the first condition is named",
          "[report][live]") {
  datasets::Campaign campaign = uis();
  campaign.conditions.resize(1);
  campaign.conditions.front().waveform = datasets::Waveform::recorded;
  CHECK_THROWS_WITH(live_cases(campaign), Catch::Contains("campaign.toml:") &&
                                              Catch::Contains("sine_0.1Hz_open_0") &&
                                              Catch::Contains("recorded"));
  campaign.conditions.front().use = datasets::Use::ignore;
  CHECK_THROWS_AS(live_cases(campaign), InputError);
}

}  // namespace
}  // namespace rigcal::report
