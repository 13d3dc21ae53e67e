#include <catch2/catch.hpp>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using Catch::WithinRel;
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
  // The fields are in the order of the page, whatever their order in the file.
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
  for (const Row& row :
       {Row{"approver = \"A. Head\"", "aprover = \"A. Head\"", "approver"},
        Row{"issued = 2026-03-02", "issued = \"yesterday\"", "issued"},
        Row{"number = \"2026-041\"", "number = 41", "number"},
        Row{"due = 2027-01-31", "until = 2027-01-31", "until"},
        Row{"number = \"2026-041\"", "revision = \"B\"", "needs 'number'"},
        Row{"number = \"2026-041\"", "replaces = \"12\"", "needs 'number'"},
        Row{"approver = \"A. Head\"", "approver_function = \"Head\"", "needs 'approver'"}}) {
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
                    Catch::Contains("the channel that the sensor measures"));
}

TEST_CASE("load_campaign: the uncertainty of a sensor is that of its channel", "[datasets]") {
  const auto loaded = [](const std::string& uncertainty) {
    return load_text(kExample + kReport + "uncertainty = \"" + uncertainty + "\"\n")
        .channels.at(datasets::Channel::position);
  };
  CHECK_THAT(loaded("0.02 mm (k = 2)").offset_sd, WithinRel(1e-5, 1e-12));
  CHECK(loaded("0.02 mm (k = 2)").gain_sd == 0.0);
  CHECK_THAT(loaded("20 um (k=1)").offset_sd, WithinRel(2e-5, 1e-12));
  CHECK_THAT(loaded("0.3 % (k = 3)").gain_sd, WithinRel(1e-3, 1e-12));
  CHECK(loaded("0.3 % (k = 3)").offset_sd == 0.0);
  for (const char* other :
       {"0.02 mm", "0.1 % of full scale (k = 2)", "0,02 mm (k = 2)", "0.02 bar (k = 2)",
        "-0.02 mm (k = 2)", "0.02 mm (k = 0)", "0.02 (k = 2)", "see certificate (k = 2)",
        "inf mm (k = 2)", "nan % (k = 2)", "0.02 mm (k = inf)"}) {
    CAPTURE(other);
    CHECK(loaded(other).offset_sd == 0.0);
    CHECK(loaded(other).gain_sd == 0.0);
    CHECK_FALSE(datasets::stated_uncertainty(other, "m").problem.empty());
  }
}

TEST_CASE("load_campaign: an uncertainty that no sensor has is refused", "[datasets]") {
  for (const char* large : {"1e300 mm (k = 2)", "0.02 mm (k = 1e-300)", "250 % (k = 2)"}) {
    CAPTURE(large);
    CHECK_THROWS_WITH(load_text(kExample + kReport + "uncertainty = \"" + large + "\"\n"),
                      Catch::Contains("uncertainty") && Catch::Contains("(k = 1)"));
  }
}

TEST_CASE("load_campaign: two statements of one sensor are the same, or both are named",
          "[datasets]") {
  const auto with = [](const std::string& channel) {
    return test::replaced(kExample, "sd = \"0.05 mm\"", "sd = \"0.05 mm\", " + channel) + kReport +
           "uncertainty = \"0.02 mm (k = 2)\"\n";
  };
  CHECK_THAT(
      load_text(with("offset_sd = \"0.01 mm\"")).channels.at(datasets::Channel::position).offset_sd,
      WithinRel(1e-5, 1e-9));
  CHECK(load_text(with("gain_sd = 0.001")).channels.at(datasets::Channel::position).gain_sd ==
        0.001);
  const std::string text = with("offset_sd = \"0.02 mm\"");
  try {
    load_text(text);
    FAIL("loaded");
  } catch (const InputError& error) {
    CHECK(error.where().line == line_of(text, "(k = 2)"));
    CHECK_THAT(error.what(),
               Catch::Contains("recording.channels.position.offset_sd") &&
                   Catch::Contains(":" + std::to_string(line_of(text, "position = {")) + ":"));
  }
  CHECK_THROWS_WITH(load_text(kExample + kReport + "uncertainty = \"0.02 mm (k = 2)\"\n" +
                              "[[report.sensor]]\nchannel = \"position\"\n"
                              "uncertainty = \"0.04 mm (k = 2)\"\n"),
                    Catch::Contains("expected the same"));
}
