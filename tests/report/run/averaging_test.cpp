#include "report/run/averaging.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

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
  const auto out = rig.folder / "out";
  HeldFolder held(out, {"average"});
  const StoredAverage average =
      write_average(held, 1, campaign, records, {"rigcal average", 1, {}, {}});
  CHECK(average.records.size() == 2);
  CHECK(average.provenance.files->front().path == "averaged/" + campaign.conditions[0].id + ".csv");
  for (const char* file : {"repeatability.csv", "average.json", "report.html"})
    CHECK(std::filesystem::exists(out / file));
  for (datasets::Condition& condition : campaign.conditions) condition.repeats.clear();
  CHECK_THROWS_WITH(averaged_records(campaign), Catch::Contains("no condition has a record"));
}

}  // namespace
}  // namespace rigcal::report
