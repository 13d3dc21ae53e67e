#include "datasets/between_days_settings.hpp"

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using Catch::Contains;

namespace {

std::string day_complaint(const std::string& line) {
  try {
    test::load_text(test::kExample + "[between_days]\n" + line + "\n");
  } catch (const InputError& error) {
    CHECK(error.where().line > 1);
    return error.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("campaign: [between_days] states by how much days differ", "[datasets]") {
  const auto campaign = test::load_text(test::kExample + R"([between_days]
supply_pressure = "20 kPa"
trigger = "0.2 ms"
position_offset = false
)");
  const datasets::BetweenDaysSettings& days = campaign.between_days;
  CHECK(days.is_stated());
  CHECK(days.sd("supply_pressure") == Approx(20e3));
  CHECK(days.sd("trigger") == Approx(0.2e-3));
  CHECK_FALSE(days.sd("bulk_modulus"));
  CHECK(days.leaves_out("position_offset"));
  CHECK_FALSE(days.leaves_out("bulk_modulus"));
  CHECK_FALSE(test::load_text(test::kExample).between_days.is_stated());
  const auto none = test::load_text("between_days = false\n" + test::kExample).between_days;
  CHECK(none.is_stated());
  CHECK(none.leaves_out("supply_pressure"));
}

TEST_CASE("campaign: a size in [between_days] that makes no sense is named with its place",
          "[datasets]") {
  CHECK_THAT(day_complaint("suply_pressure = \"1 kPa\""), Contains("supply_pressure"));
  CHECK_THAT(day_complaint("supply_pressure = \"1 mm\""), Contains("supply_pressure"));
  CHECK_THAT(day_complaint("supply_pressure = \"0 Pa\""), Contains("above zero"));
  CHECK_THAT(day_complaint("bulk_modulus = \"-3 MPa\""), Contains("above zero"));
  CHECK_THAT(day_complaint("supply_pressure = \"100 MPa\""), Contains("at most"));
  CHECK_THAT(day_complaint("trigger = \"2 s\""), Contains("at most"));
  CHECK_THAT(day_complaint("trigger = true"), Contains("false"));
}
