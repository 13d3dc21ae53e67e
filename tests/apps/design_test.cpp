#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"
#include "tests/apps/two_chamber_fixture.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;

const std::string kDesign = R"([design]
stroke = ["-6 mm", "8 mm"]
speed = "0.1 m/s"
acceleration = "5 m/s2"
command = "5 V"
flow = "3 L/min"
duration = "2 s"
sample_rate = "200 Hz"
repeats = 3
evaluations = 16
like = "sine"
)";

/// The campaign with its synthetic parameters and a design.
std::string campaign_with(const std::string& design, const Edits& edits = {}) {
  return edited(kCampaign, edits) + kSynthetic + design;
}

/// Writes records of the designed test, with its drive in addition to signals that `synthesize`
/// makes.
void write_dummy_records(const CommandFolder& folder, const std::string& header,
                         const std::string& rest, const std::string& condition) {
  std::istringstream drive(folder.read("out/design.csv"));
  std::string line;
  std::getline(drive, line);
  std::string csv = header;
  while (std::getline(drive, line)) csv += line + rest + "\n";
  for (int repeat = 1; repeat <= 3; ++repeat)
    folder.write("out/records/" + condition + "_r" + std::to_string(repeat) + ".csv", csv);
}

}  // namespace

TEST_CASE("plan --design: a drive, a picture, a campaign file; fits of its records are right",
          "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml",
               edited(campaign_with(kDesign), {{"repeats = [\"records/sine_*.csv\"]", ""},
                                               {"repeats = [\"records/square_*.csv\"]", ""}}));
  const CommandFolder::Arguments arguments{
      "plan", "campaign.toml", "--design", "damping,valve_gain", "--out", "out"};
  const Outcome outcome = folder.run(arguments);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("DESIGN") && Contains("Own over this") && Contains("speed") &&
                              Contains("multisine") && Contains("out/design.csv"));
  const auto json = nlohmann::json::parse(folder.read("out/plan.json"));
  CHECK(violations(json, "plan") == "");
  const auto& design = json["design"];
  CHECK(design["status"] == "done");
  CHECK(design["families"].size() == 4);
  CHECK(design["leak_level"] == "none");
  CHECK(design["own_signals"] == nlohmann::json({"sine", "square"}));
  REQUIRE(design["limits"].size() == 6);
  for (const auto& limit : design["limits"]) CHECK(limit["share_percent"].get<double>() <= 100.0);
  CHECK(json["records"].size() == 2);
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("id=\"design\"") && Contains("Drive and predicted position") &&
                       Contains("Spectrum of drive") && Contains("The designed test"));
  REQUIRE(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);

  CHECK_THAT(folder.read("out/design.csv"), Catch::StartsWith("time_s,reference_mm\n0,0\n"));
  CHECK(folder.read("out/rigcal-manifest.json").find("design.toml") != std::string::npos);
  const std::string condition = "design_" + design["family"].get<std::string>();
  // Without recordings the campaign is rejected, and the message names the missing ones.
  const Outcome missing = folder.run({"check", "out/design.toml"});
  CHECK(missing.exit_code == 2);
  CHECK_THAT(missing.err, Contains(condition + "_r1.csv"));
  write_dummy_records(folder, "t_s,ref_mm,x_mm,pl_bar\n", ",0,0", condition);
  folder.write("out/truth.toml", folder.read("out/design.toml") + kSynthetic);
  const Outcome made =
      folder.run({"synthesize", "out/truth.toml", "--seed", "4", "--out", "made", "--quiet"});
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  REQUIRE(folder.run({"check", "made/campaign.toml"}).exit_code == 0);
  const Outcome fitted = folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"});
  CAPTURE(fitted.err);
  CHECK(fitted.exit_code == 0);
  const auto fit = nlohmann::json::parse(folder.read("fit/fit.json"));
  const auto value = [&](const char* name) -> double {
    for (const auto& each : fit["parameters"])
      if (each["name"] == name) return each["value"];
    return std::nan("");
  };
  CHECK(value("damping_n_s_per_m") == Approx(1000.0).epsilon(0.05));
  CHECK(value("valve_gain_m_per_v") == Approx(3e-5).epsilon(0.02));

  // Another design in the same folder replaces the first one. A plan without a design removes it.
  CHECK(folder.run({"plan", "campaign.toml", "--out", "out", "--quiet"}).exit_code == 0);
  CHECK_FALSE(folder.has("out/design.csv"));
  CHECK_FALSE(nlohmann::json::parse(folder.read("out/plan.json")).contains("design"));
}

TEST_CASE("plan --design: a cylinder on the command of its valve", "[apps]") {
  const CommandFolder folder;
  const std::string design = R"([design]
stroke = ["-30 mm", "30 mm"]
speed = "0.2 m/s"
command = "2 V"
duration = "2 s"
sample_rate = "200 Hz"
evaluations = 8
criterion = "worst"
family = "steps"
)";
  folder.write("campaign.toml",
               edited(kTwoChamber, {{"repeats = [\"records/square_*.csv\"]", ""}}) +
                   kTwoChamberTruth + design);
  const Outcome outcome =
      folder.run({"plan", "campaign.toml", "--design", "mass", "--out", "out", "--threads", "2"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(folder.read("out/plan.json"));
  CHECK(json["design"]["family"] == "steps");
  CHECK(json["design"]["criterion"] == "worst");
  CHECK_THAT(folder.read("out/design.csv"), Catch::StartsWith("time_s,command_V\n0,0\n"));
  const std::string next = folder.read("out/design.toml");
  CHECK_THAT(next, Contains("id = \"design_steps\"") && Contains("role = \"input\"") &&
                       Contains("waveform = \"recorded\"") && !Contains("[synthetic]") &&
                       !Contains("[design]") && Contains("design_steps_r5.csv"));
  CHECK_THAT(folder.read("out/report.html"), Contains("Predicted position"));
}

TEST_CASE("plan --design: what is wrong is named with its place", "[apps]") {
  struct Case {
    const char* name;
    Edits edits;
    const char* names;
    const char* message;
  };
  const CommandFolder folder;
  const std::vector<Case> cases{
      {"unknown parameter", {}, "dampin", "did you mean 'damping'"},
      {"known parameter",
       {},
       "mass",
       "key 'rig.parameters.mass': --design names it, but it is not"},
      {"unknown key", {{"speed =", "sped ="}}, "damping", "did you mean 'speed'"},
      {"no stroke", {{"stroke = [\"-6 mm\", \"8 mm\"]\n", ""}}, "damping", "stroke"},
      {"stroke of one end", {{"\"-6 mm\", ", ""}}, "damping", "key 'design.stroke'"},
      {"stroke turned round", {{"-6 mm", "9 mm"}}, "damping", "not above its beginning"},
      {"stroke in V", {{"-6 mm", "-6 V"}}, "damping", "key 'design.stroke"},
      {"negative speed", {{"0.1 m/s", "-0.1 m/s"}}, "damping", "key 'design.speed'"},
      {"no acceleration", {{"5 m/s2", "0 m/s2"}}, "damping", "key 'design.acceleration'"},
      {"flow in bar", {{"3 L/min", "3 bar"}}, "damping", "key 'design.flow'"},
      {"no duration",
       {{"duration = \"2 s\"\nsample_rate = \"200 Hz\"\nrepeats = 3\nevaluations",
         "sample_rate = \"200 Hz\"\nrepeats = 3\nevaluations"}},
       "damping",
       "duration"},
      {"too many samples",
       {{"sample_rate = \"200 Hz\"\nrepeats = 3\nevaluations",
         "sample_rate = \"1 MHz\"\nrepeats = 3\nevaluations"}},
       "damping",
       "2000000 samples"},
      {"family", {{"like = \"sine\"", "family = \"square\""}}, "damping", "key 'design.family'"},
      {"criterion",
       {{"like = \"sine\"", "criterion = \"best\""}},
       "damping",
       "key 'design.criterion'"},
      {"band",
       {{"like = \"sine\"", "band = [\"1 Hz\", \"150 Hz\"]"}},
       "damping",
       "above half the sample rate"},
      {"repeats",
       {{"repeats = 3\nevaluations", "repeats = 0\nevaluations"}},
       "damping",
       "key 'design.repeats'"},
      {"evaluations",
       {{"evaluations = 16", "evaluations = -1"}},
       "damping",
       "key 'design.evaluations'"},
      {"like", {{"like = \"sine\"", "like = \"sin\""}}, "damping", "key 'design.like'"},
      {"noise of no output",
       {{"like = \"sine\"", "noise = { force = \"1 N\" }"}},
       "damping",
       "key 'design.noise.force'"},
      {"stroke away from the rig",
       {{"-6 mm", "1 mm"}},
       "damping",
       "no drive can stay within this limit"},
  };
  for (const Case& each : cases) {
    CAPTURE(each.name);
    folder.write("campaign.toml", edited(edited(campaign_with(kDesign),
                                                {{"repeats = [\"records/sine_*.csv\"]", ""},
                                                 {"repeats = [\"records/square_*.csv\"]", ""}}),
                                         each.edits));
    const Outcome outcome =
        folder.run({"plan", "campaign.toml", "--design", each.names, "--out", "o"});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains(each.message));
    if (std::string(each.names) != "dampin") CHECK_THAT(outcome.err, Contains("campaign.toml:"));
    CHECK_FALSE(folder.has("o/plan.json"));
  }
  folder.write("campaign.toml", campaign_with(""));
  CHECK_THAT(folder.run({"plan", "campaign.toml", "--design", "damping", "--out", "o"}).err,
             Contains("campaign.toml"));
}

TEST_CASE("plan --design: a signal ends the search with the best drive until then", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml",
               edited(campaign_with(kDesign), {{"repeats = [\"records/sine_*.csv\"]", ""},
                                               {"repeats = [\"records/square_*.csv\"]", ""},
                                               {"evaluations = 16", "evaluations = 100000"}}));
  const Outcome outcome =
      folder.run_and_signal({"plan", "campaign.toml", "--design", "damping", "--out", "out"},
                            "of 100000 drives (multisine)", SIGTERM);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 4);
  const auto json = nlohmann::json::parse(folder.read("out/plan.json"));
  CHECK(json["design"]["status"] == "stopped");
  CHECK(folder.has("out/design.csv"));
  CHECK_THAT(folder.read("out/report.html"), Contains("stopped by a signal"));
}

}  // namespace rigcal::test
