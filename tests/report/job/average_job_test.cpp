#include <catch2/catch.hpp>
#include <filesystem>

#include "report/job/job.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("average_job: records of all conditions that are not ignored", "[report][run]") {
  test::MadeRig rig;
  datasets::Campaign campaign = load(rig.choice);
  campaign.conditions[1].use = datasets::Use::ignore;
  const auto out = rig.folder / "out";
  const std::atomic<bool> cancel{false};
  std::optional<HeldFolder> held;
  JobTerms terms{"rigcal average", {}, 1, cancel};
  terms.hold = [&](PlannedFiles planned) {
    held.emplace(out, Holding{"average"});
    held->plan(std::move(planned));
  };
  const auto records = averaged_records(campaign, terms);
  REQUIRE(records.size() == 2);
  CHECK(records[1].condition == campaign.conditions[2].id);
  const auto documents = write_job(*held, 1, average_job(campaign, records, terms)).documents;
  REQUIRE(documents.size() == 1);
  CHECK(documents.front().verdict.badge.words == "AVERAGED");
  const Json average = Json::parse(test::text_of(out / "average.json"));
  CHECK(average["records"].size() == 2);
  CHECK(average["provenance"]["files"][0]["path"] ==
        "averaged/" + campaign.conditions[0].id + ".csv");
  for (const char* file : {"repeatability.csv", "average.json", "report.html"})
    CHECK(std::filesystem::exists(out / file));
  for (datasets::Condition& condition : campaign.conditions) condition.repeats.clear();
  CHECK_THROWS_WITH(averaged_records(campaign, terms),
                    Catch::Contains("no condition has a record"));
}

}  // namespace
}  // namespace rigcal::report
