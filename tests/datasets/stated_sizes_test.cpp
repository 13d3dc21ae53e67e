#include "datasets/stated_sizes.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using Catch::Contains;

namespace {

std::string complaint(const std::string& section, const std::string& line) {
  return test::complaint_of(
      [&] { test::load_text(test::kExample + "[" + section + "]\n" + line + "\n"); });
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
  CHECK_THAT(complaint("considered", "valve_lag = \"1 ms\""), Contains("valve_time_constant"));
  CHECK_THAT(complaint("considered", "valve_time_constant = \"1 mm\""),
             Contains("valve_time_constant"));
  CHECK_THAT(complaint("considered", "valve_time_constant = \"0 ms\""), Contains("above zero"));
  CHECK_THAT(complaint("considered", "coulomb_friction = \"-3 N\""), Contains("above zero"));
  CHECK_THAT(complaint("considered", "valve_time_constant = \"100 s\""), Contains("at most"));
  CHECK_THAT(complaint("considered", "supply_sag = 2"), Contains("at most"));
  CHECK_THAT(complaint("considered", "coulomb_friction = true"), Contains("false"));
  CHECK_THAT(complaint("considered", "position_offset = \"1 mm\""),
             Contains("already in the model"));
}

TEST_CASE("campaign: [between_days] states by how much days differ", "[datasets]") {
  const auto campaign = test::load_text(test::kExample + R"([between_days]
supply_pressure = "20 kPa"
trigger = "0.2 ms"
position_offset = false
)");
  const datasets::StatedSizes& days = campaign.between_days;
  CHECK(days.is_stated());
  CHECK(days.size("supply_pressure") == Approx(20e3));
  CHECK(days.size("trigger") == Approx(0.2e-3));
  CHECK_FALSE(days.size("bulk_modulus"));
  CHECK(days.leaves_out("position_offset"));
  CHECK_FALSE(days.leaves_out("bulk_modulus"));
  CHECK_FALSE(test::load_text(test::kExample).between_days.is_stated());
  const auto none = test::load_text("between_days = false\n" + test::kExample).between_days;
  CHECK(none.is_stated());
  CHECK(none.leaves_out("supply_pressure"));
}

TEST_CASE("campaign: a size in [between_days] that makes no sense is named with its place",
          "[datasets]") {
  CHECK_THAT(complaint("between_days", "suply_pressure = \"1 kPa\""), Contains("supply_pressure"));
  CHECK_THAT(complaint("between_days", "supply_pressure = \"1 mm\""), Contains("supply_pressure"));
  CHECK_THAT(complaint("between_days", "supply_pressure = \"0 Pa\""), Contains("above zero"));
  CHECK_THAT(complaint("between_days", "bulk_modulus = \"-3 MPa\""), Contains("above zero"));
  CHECK_THAT(complaint("between_days", "supply_pressure = \"100 MPa\""), Contains("at most"));
  CHECK_THAT(complaint("between_days", "trigger = \"2 s\""), Contains("at most"));
  CHECK_THAT(complaint("between_days", "trigger = true"), Contains("false"));
}
