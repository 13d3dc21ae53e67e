#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using rigcal::test::kExample;
using rigcal::test::line_of;
using rigcal::test::load_text;

namespace {

const std::string kReport = R"(
[report]
approver = "A. Head"
number = "2026-041"
issued = 2026-03-02
[[report.sensor]]
channel = "position"
due = 2027-01-31
)";

}  // namespace

TEST_CASE("load_campaign: what a test report states", "[datasets]") {
  const datasets::Campaign campaign = load_text(kExample + kReport);
  using Fields = datasets::ReportSettings::Fields;
  // In the order of the page, whatever that of the file.
  CHECK(campaign.report.fields ==
        Fields{{"number", "2026-041"}, {"issued", "2026-03-02"}, {"approver", "A. Head"}});
  REQUIRE(campaign.report.sensors.size() == 1);
  CHECK(campaign.report.sensors[0] == Fields{{"channel", "position"}, {"due", "2027-01-31"}});
  CHECK(load_text(kExample).report.empty());
  CHECK_FALSE(load_text(kExample + "[[report.sensor]]\nchannel = \"position\"\n").report.empty());
}

TEST_CASE("load_campaign: a wrong report names key and line", "[datasets]") {
  struct Row {
    const char* from;
    const char* to;
    const char* says;
  };
  for (const Row& row : {Row{"approver = \"A. Head\"", "aprover = \"A. Head\"", "approver"},
                         Row{"issued = 2026-03-02", "issued = \"yesterday\"", "issued"},
                         Row{"number = \"2026-041\"", "number = 41", "number"},
                         Row{"due = 2027-01-31", "until = 2027-01-31", "until"}}) {
    CAPTURE(row.to);
    const std::string text = test::replaced(kExample + kReport, row.from, row.to);
    try {
      load_text(text);
      FAIL("loaded");
    } catch (const InputError& error) {
      CHECK(error.where().line == line_of(text, row.to));
      CHECK_THAT(error.what(), Catch::Contains(row.says));
    }
  }
  CHECK_THROWS_WITH(load_text(test::replaced(kExample + kReport, "channel = \"position\"\n", "")),
                    Catch::Contains("the channel that the sensor is of"));
}
