#include <catch2/catch.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;

namespace {

/// Renames a column in the first repeat of the sine.
void rename_column(const CommandFolder& folder, const std::string& from, const std::string& to) {
  const std::string file = "records/sine_1.csv";
  folder.write(file, replaced(folder.read(file), from, to));
}

}  // namespace

TEST_CASE("file units: a contradiction is refused by every verb that reads the record", "[apps]") {
  const CommandFolder folder;
  const Edits column{
      {"load_pressure = { column = \"pl_bar\"", "load_pressure = { column = \"pl\""}};
  write_campaign(folder, column);
  for (const char* name : {"sine_1", "sine_2", "square_1", "square_2"}) {
    const std::string file = std::string("records/") + name + ".csv";
    folder.write(file, replaced(folder.read(file), "pl_bar", "pl [bar]"));
  }
  REQUIRE(folder.run({"check", "campaign.toml"}).exit_code == 0);
  rename_column(folder, "pl [bar]", "pl [psi]");
  for (const char* verb : {"check", "fit", "validate", "average"}) {
    CAPTURE(verb);
    const Outcome outcome = folder.run({verb, "campaign.toml"});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("records/sine_1.csv:1: column 'pl [psi]' is in psi") &&
                                Contains("load_pressure says unit = \"bar\"") &&
                                Contains("campaign.toml:"));
  }
  Edits ignoring = column;
  ignoring.emplace_back("unit = \"bar\" }", "unit = \"bar\", ignore_unit = \"psi\" }");
  folder.write("campaign.toml", edited(kCampaign, ignoring));
  CHECK(folder.run({"check", "campaign.toml"}).exit_code == 0);
  rename_column(folder, "pl [psi]", "pl [kPa]");
  CHECK(folder.run({"check", "campaign.toml"}).exit_code == 2);
}

TEST_CASE("file units: the time, and names without brackets", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  REQUIRE(folder.run({"check", "campaign.toml"}).exit_code == 0);
  folder.write(
      "campaign.toml",
      edited(kCampaign, {{"column = \"x_mm\", unit = \"mm\"", "column = \"x_mm\", unit = \"m\""}}));
  CHECK_THAT(folder.run({"check", "campaign.toml"}).err,
             Contains("column 'x_mm' is in mm") && Contains("recording.channels.position says"));
  folder.write("campaign.toml",
               edited(kCampaign, {{"column = \"x_mm\", unit = \"mm\"",
                                   "column = \"x_mm\", unit = \"m\", gain = 1e-3"}}));
  CHECK(folder.run({"check", "campaign.toml"}).exit_code == 0);
  write_campaign(folder, {{"column = \"t_s\", unit = \"s\"", "column = \"t\", unit = \"s\""}});
  rename_column(folder, "t_s", "t [ms]");
  CHECK_THAT(folder.run({"check", "campaign.toml"}).err,
             Contains("column 't [ms]' is in ms") && Contains("recording.channels.time says"));
}
