#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/two_chamber_fixture.hpp"
#include "tests/support/sanitized.hpp"

using namespace rigcal::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// Values for the blanks in a draft for the load-pressure plant.
const Edits kValues{
    {"\"FILL IN kg\"", "\"60 kg\""},        {"\"FILL IN N s/m\"", "\"2000 N s/m\""},
    {"\"FILL IN N/m\"", "\"0 N/m\""},       {"\"FILL IN m2\"", "\"633 mm2\""},
    {"\"FILL IN m3\"", "\"468 cm3\""},      {"\"FILL IN Pa\"", "\"6.2 MPa\""},
    {"\"FILL IN kg/m3\"", "\"850 kg/m3\""}, {"\"FILL IN Pa\"", "\"689 MPa\""},
    {"\"FILL IN\"  # C_d", "0.6  # C_d"},   {"\"FILL IN m\"", "\"20 mm\""},
    {"\"FILL IN m/V\"", "\"2e-5 m/V\""},    {"\"FILL IN\"  # C_leak", "0.3  # C_leak"},
    {"\"FILL IN m2\"", "\"1 mm2\""},        {"\"FILL IN V/m\"", "\"1000 V/m\""}};

/// Values for the blanks in a draft for the two-chamber plant.
const Edits kTwoChamberValues{{"\"FILL IN kg\"", "\"5 kg\""},
                              {"\"FILL IN N s/m\"", "\"300 N s/m\""},
                              {"\"FILL IN N/m\"", "\"0 N/m\""},
                              {"area_a = \"FILL IN m2\"", "area_a = \"2 cm2\""},
                              {"area_b = \"FILL IN m2\"", "area_b = \"1.2 cm2\""},
                              {"stroke = \"FILL IN m\"", "stroke = \"200 mm\""},
                              {"dead_volume_a = \"FILL IN m3\"", "dead_volume_a = \"20 cm3\""},
                              {"dead_volume_b = \"FILL IN m3\"", "dead_volume_b = \"30 cm3\""},
                              {"tank_pressure = \"FILL IN Pa\"", "tank_pressure = \"1 bar\""},
                              {"supply_pressure = \"FILL IN Pa\"", "supply_pressure = \"44 bar\""},
                              {"\"FILL IN kg/m3\"", "\"850 kg/m3\""},
                              {"bulk_modulus = \"FILL IN Pa\"", "bulk_modulus = \"500 MPa\""},
                              {"\"FILL IN\"  # C_d", "0.6  # C_d"},
                              {"area_gradient = \"FILL IN m\"", "area_gradient = \"20 mm\""},
                              {"valve_gain = \"FILL IN m/V\"",
                               "valve_gain = { start = \"5e-6 m/V\", lower = \"1e-6 m/V\", upper = "
                               "\"2e-5 m/V\", fit = true }"},
                              {"\"FILL IN\"  # C_leak", "0  # C_leak"},
                              {"leakage_area = \"FILL IN m2\"", "leakage_area = \"1 mm2\""}};

/// Returns the folder with the Festo recordings. If it does not exist, prints a message and returns
/// an empty path.
std::filesystem::path festo_records() {
  std::filesystem::path folder =
      std::filesystem::path(RIGCAL_RECORDINGS_DIR) / "festo_tp511_servo_cylinder";
  if (std::filesystem::exists(folder)) return folder;
  WARN("skipped: no recordings here");
  return {};
}

}  // namespace

TEST_CASE("init: a draft that check accepts once its blanks are filled", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const Outcome made = folder.run({"init", "records/sine_1.csv", "records/sine_2.csv",
                                   "records/square_1.csv", "records/square_2.csv", "--out", "new"});
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("new/campaign.toml") && Contains("blanks marked \"FILL IN\""));
  const std::string draft = folder.read("new/campaign.toml");
  // kValues fills every blank; "FILL IN" in the header is none.
  CHECK_THAT(made.out, Contains("\n" + std::to_string(kValues.size()) + " blanks marked"));
  CHECK_THAT(draft, StartsWith("#:schema ./campaign.schema.json\n"));
  CHECK(folder.read("new/campaign.schema.json") == folder.run({"schema", "campaign"}).out);
  CHECK_THAT(draft, Contains("frequency = \"2 Hz\"") && Contains("amplitude = \"5 mm\"") &&
                        Contains("id = \"square\"") && Contains("\"../records/sine_2.csv\""));

  const Outcome empty = folder.run({"check", "new/campaign.toml"});
  CHECK(empty.exit_code == 2);
  CHECK_THAT(empty.err, Contains("FILL IN"));

  folder.write("new/campaign.toml", edited(draft, kValues));
  const Outcome checked = folder.run({"check", "new/campaign.toml"});
  CHECK(checked.err.empty());
  CHECK(checked.exit_code == 0);
  CHECK_THAT(checked.out, Contains("sine: fit, 400 samples at 200 Hz") && Contains("2 repeats"));
}

TEST_CASE("init: a folder stands for the recordings in it", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  folder.write("records/notes.md", "measured on a Monday");
  std::filesystem::create_symlink("loop.csv", folder.work() / "records/loop.csv");
  REQUIRE(folder.run({"init", "records", "--out", "new"}).exit_code == 0);
  REQUIRE(folder
              .run({"init", "records/sine_1.csv", "records/sine_2.csv", "records/square_1.csv",
                    "records/square_2.csv", "--out", "other"})
              .exit_code == 0);
  CHECK(folder.read("new/campaign.toml") == folder.read("other/campaign.toml"));
}

TEST_CASE("init: from recordings of both chambers to a fit", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_two_chamber_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"init", "twin/records", "--out", "new", "--quiet"}).exit_code == 0);
  const std::string draft = folder.read("new/campaign.toml");
  CHECK_THAT(draft, Contains("model = \"two_chamber\"") && Contains("type = \"none\"") &&
                        Contains("pressure_a = { column = \"pA_bar\", unit = \"bar\" }") &&
                        Contains("pressure_b = { column = \"pB_bar\", unit = \"bar\" }"));
  const Outcome empty = folder.run({"check", "new/campaign.toml"});
  CHECK(empty.exit_code == 2);
  CHECK_THAT(empty.err, Contains("FILL IN"));
  folder.write("new/campaign.toml", edited(draft, kTwoChamberValues));
  const Outcome checked = folder.run({"check", "new/campaign.toml"});
  CHECK(checked.err.empty());
  CHECK(checked.exit_code == 0);
  const Outcome fitted = folder.run({"fit", "new/campaign.toml", "--out", "results", "--quiet"});
  CHECK(fitted.err.empty());
  CHECK(fitted.exit_code == 0);
  CHECK(folder.has("results/report.html"));
}

TEST_CASE("init: the Festo records", "[apps]") {
  const std::filesystem::path records = festo_records();
  if (records.empty()) return;
  const CommandFolder folder;
  CommandFolder::Arguments init{"init",
                                "--out",
                                "new",
                                "--quiet",
                                (records / "steps_1V_1kHz.csv").string(),
                                (records / "steps_4V_1kHz.csv").string()};
  if (!kSanitized) init.push_back((records / "steps_2V_1kHz.csv").string());
  REQUIRE(folder.run(init).exit_code == 0);
  const std::string draft = folder.read("new/campaign.toml");
  CHECK_THAT(draft, Contains("model = \"two_chamber\"") && Contains("type = \"none\"") &&
                        Contains("command = { column = \"u_V\", unit = \"V\" }") &&
                        Contains("pressure_b = { unit = \"bar\" }") &&
                        Contains("position = \"x_mm_B{n}\", pressure_b = \"pB_bar_{n}\"") &&
                        Contains("id = \"steps_4V_1kHz\""));
  folder.write("new/campaign.toml", edited(draft, kTwoChamberValues));
  const Outcome checked = folder.run({"check", "new/campaign.toml"});
  CHECK(checked.err.empty());
  CHECK(checked.exit_code == 0);
  CHECK_THAT(checked.out, Contains("steps_1V_1kHz: fit") && Contains("20 repeats"));
}

TEST_CASE("init: a folder with a file that is no record", "[apps]") {
  const std::filesystem::path records = festo_records();
  if (records.empty()) return;
  const CommandFolder folder;
  const Outcome all = folder.run({"init", records.string(), "--out", "new"});
  CHECK(all.exit_code == 0);
  // One file has several records below each other, and another is a table of speeds.
  CHECK_THAT(all.out,
             Contains("warning: left out: transients_10kHz_mean_of_10_repeats.csv:8002:7: time") &&
                 Contains("warning: left out: run_summary.csv (no column looks like a time"));
  CHECK_THAT(folder.read("new/campaign.toml"), Contains("id = \"steps_4V_1kHz\""));
}

TEST_CASE("init: what it refuses", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  folder.write("empty/notes.md", "none");
  CHECK_THAT(folder.run({"init", "empty"}).err, Contains("empty: this folder has no .csv"));
  CHECK(folder.run({"init"}).exit_code == 2);
  const Outcome missing = folder.run({"init", "records/none.csv"});
  CHECK(missing.exit_code == 2);
  CHECK_THAT(missing.err, Contains("records/none.csv: cannot be opened"));
  std::filesystem::create_symlink("loop.csv", folder.work() / "loop.csv");
  const Outcome loop = folder.run({"init", "loop.csv"});
  CHECK(loop.exit_code == 2);
  CHECK_THAT(loop.err, Contains("loop.csv: cannot be opened"));
  folder.write("odd.csv", "a,b\n1,2\n");
  CHECK_THAT(folder.run({"init", "odd.csv"}).err, Contains("odd.csv: no column looks like a time"));
  folder.write("tdms/run.tdms", std::string("TDSm\x0e\0\0\0", 8));
  const Outcome tdms = folder.run({"init", "tdms"});
  CHECK(tdms.exit_code == 2);
  CHECK_THAT(tdms.err, Contains("run.tdms: is TDMS, of LabVIEW, which rigcal cannot read") &&
                           Contains("expected CSV"));
  CHECK_FALSE(folder.has("rigcal-out/campaign.toml"));

  REQUIRE(folder.run({"init", "records/sine_1.csv", "--out", "new", "--quiet"}).exit_code == 0);
  const std::string draft = folder.read("new/campaign.toml");
  CHECK(folder.run({"init", "records/sine_1.csv", "--out", "new", "--quiet"}).exit_code == 0);
  CHECK(folder.read("new/campaign.toml") == draft);
  folder.write("new/campaign.toml", draft + "# filled in\n");
  const Outcome again = folder.run({"init", "records/sine_1.csv", "--out", "new"});
  CHECK(again.exit_code == 2);
  CHECK(folder.read("new/campaign.toml") == draft + "# filled in\n");
  CHECK_THAT(again.err, Contains("campaign.toml: changed since rigcal wrote it"));
}
