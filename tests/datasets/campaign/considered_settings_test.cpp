#include "datasets/considered_settings.hpp"

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using Catch::Contains;

namespace {

std::string complaint(const std::string& line) {
  try {
    test::load_text(test::kExample + "[considered]\n" + line + "\n");
  } catch (const InputError& error) {
    CHECK(error.where().line > 1);
    return error.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("campaign: [considered] changes sizes and leaves effects out", "[datasets]") {
  const auto campaign = test::load_text(test::kExample + R"([considered]
valve_time_constant = "1 ms"
coulomb_friction = false
supply_sag = 0.02
)");
  CHECK(campaign.considered.size("valve_time_constant") == 1e-3);
  CHECK(campaign.considered.size("supply_sag") == 0.02);
  CHECK_FALSE(campaign.considered.size("valve_dead_band"));
  CHECK(campaign.considered.leaves_out("coulomb_friction"));
  CHECK_FALSE(campaign.considered.leaves_out("valve_time_constant"));
}

TEST_CASE("campaign: a size in [considered] that makes no sense is named with its place",
          "[datasets]") {
  CHECK_THAT(complaint("valve_lag = \"1 ms\""), Contains("valve_time_constant"));
  CHECK_THAT(complaint("valve_time_constant = \"1 mm\""), Contains("valve_time_constant"));
  CHECK_THAT(complaint("valve_time_constant = \"0 ms\""), Contains("above zero"));
  CHECK_THAT(complaint("coulomb_friction = \"-3 N\""), Contains("above zero"));
  CHECK_THAT(complaint("valve_time_constant = \"100 s\""), Contains("at most"));
  CHECK_THAT(complaint("supply_sag = 2"), Contains("at most"));
  CHECK_THAT(complaint("coulomb_friction = true"), Contains("false"));
  CHECK_THAT(complaint("position_offset = \"1 mm\""), Contains("in the model already"));
}
