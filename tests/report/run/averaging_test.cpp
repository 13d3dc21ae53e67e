#include "report/run/averaging.hpp"

#include <catch2/catch.hpp>

#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("averaging: records of all conditions that are not ignored", "[report][run]") {
  test::MadeRig rig;
  datasets::Campaign campaign = load(rig.choice);
  campaign.conditions[1].use = datasets::Use::ignore;
  const auto records = averaged_records(campaign);
  REQUIRE(records.size() == 2);
  CHECK(records[1].condition == campaign.conditions[2].id);
  const auto files = averaged_files(records);
  REQUIRE(files.size() == 3);
  CHECK(files[0].path == "averaged/" + campaign.conditions[0].id + ".csv");
  CHECK(files[2].path == "repeatability.csv");
  for (datasets::Condition& condition : campaign.conditions) condition.repeats.clear();
  CHECK_THROWS_WITH(averaged_records(campaign), Catch::Contains("no condition has a record"));
}

}  // namespace
}  // namespace rigcal::report
