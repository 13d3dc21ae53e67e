#include "report/run/check.hpp"

#include <catch2/catch.hpp>

#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("check: tells of every record, and hands it on", "[report][run]") {
  test::MadeRig rig;
  datasets::Campaign campaign = load(rig.choice);
  campaign.conditions[0].repeats.clear();
  campaign.conditions[1].duration_s = 100.0;  // but its records are 4 s long
  std::vector<std::string> kept;
  const Check found =
      check(campaign, [&](const datasets::Record& record) { kept.push_back(record.condition); });
  CHECK(kept == std::vector<std::string>{campaign.conditions[1].id, campaign.conditions[2].id});
  CHECK(found.json["without_record"][0] == campaign.conditions[0].id);
  REQUIRE(found.json["records"].size() == 2);
  CHECK(found.json["records"][0]["warnings"].size() == 1);
  CHECK(found.text.find(campaign.conditions[0].id + ": fit, no record\n") == 0);
  CHECK(found.text.find("  warning: ") != std::string::npos);
}

}  // namespace
}  // namespace rigcal::report
