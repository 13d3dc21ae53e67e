#include <algorithm>
#include <catch2/catch.hpp>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

using namespace rigcal::test;
using Catch::Contains;
using Catch::StartsWith;
using Catch::WithinRel;
using nlohmann::json;

namespace {

/// Tables for kCampaign's rig, printed by `leak-table` at kp = 1000 V/m and 1 mm2.
const std::string kTables = R"([leak_table]
targets = [10, 30]
[leak_table.assumptions]
kp = { value = "1000 V/m", source = "a guess", fit = true, start = "700 V/m", lower = "100 V/m", upper = "5000 V/m" }
leakage_area = { value = "1 mm2", source = "a guess", fit = true, start = "2 mm2", lower = "0.1 mm2", upper = "10 mm2" }
[[leak_table.signal]]
waveform = "sine"
frequency = "2 Hz"
amplitude = "5 mm"
printed = ["C10", "C30"]
[leak_table.features]
waveform = "sine"
frequency = "2 Hz"
amplitude = "5 mm"
[[leak_table.features.row]]
level = "some"
coefficient = 0.3
servo_flow = "QS m3/s"
leak_flow = "QL m3/s"
)";

/// Formats a number for a campaign file, with all digits and without an exponent.
std::string fmt_number(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(15) << value;
  return text.str();
}

void write_rig(const CommandFolder& folder, const std::string& section = "") {
  write_campaign(folder);
  folder.write("campaign.toml", kCampaign + section);
}

void check_refused(const CommandFolder& folder, const CommandFolder::Arguments& arguments,
                   const std::string& part) {
  const Outcome outcome = folder.run(arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, StartsWith("rigcal: ") && Contains(part));
  CHECK_FALSE(folder.has("rigcal-out"));
}

}  // namespace

TEST_CASE("leak-table: any rig, without records, writes table and JSON", "[apps]") {
  const CommandFolder folder;
  write_rig(folder);
  const Outcome outcome = folder.run({"leak-table", "campaign.toml", "--targets", "10,30",
                                      "--signals", "sine@2Hz@5mm", "--out", "out"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("10 %") && Contains("sine 2 Hz"));
  const json table = json::parse(folder.read("out/leak_table.json"));
  CHECK(table["schema"] == "rigcal.leak_table/1");
  REQUIRE(table["entries"].size() == 2);
  for (const json& entry : table["entries"]) {
    CHECK(entry["waveform"] == "sine");
    CHECK(entry["frequency_hz"] == 2.0);
    REQUIRE(entry["coefficients"].size() == 1);
    CHECK(entry["coefficients"][0].get<double>() > 0.0);
    CHECK(entry["published_coefficient"].is_null());
    CHECK(entry["grade"] == "not published");
    CHECK(entry["log_slope"].get<double>() > 0.0);
  }
  CHECK(table["entries"][0]["coefficients"][0].get<double>() <
        table["entries"][1]["coefficients"][0].get<double>());
  CHECK_FALSE(table["assumptions"].empty());
  CHECK_FALSE(table["fixed_combinations"].empty());
  CHECK(table["provenance"]["options"]["targets"] == "10,30");
  const std::string csv = folder.read("out/leak_table.csv");
  CHECK_THAT(csv, StartsWith("waveform,frequency_hz,amplitude_m,target_percent,coefficients"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK_FALSE(folder.has("out/features.csv"));
  CHECK(violations(table, "leak_table") == "");
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("id=\"leak-table\"") && Contains("sine 2 Hz, 5 mm"));
  const double first = table["entries"][0]["coefficients"][0].get<double>();
  const std::string before = "<data value=\"";
  const std::size_t at = page.find(before, page.find("class=\"cell "));
  REQUIRE(at != std::string::npos);
  CHECK(std::stod(page.substr(at + before.size())) == first);
}

TEST_CASE("leak-table: --set reaches it, a rig with a tenfold volume has a table too", "[apps]") {
  const CommandFolder folder;
  write_rig(folder);
  const Outcome outcome =
      folder.run({"leak-table", "campaign.toml", "--targets", "20", "--signals", "sine@2Hz@5mm",
                  "--set", "total_volume=4680 cm3", "--out", "out", "--json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const json table = json::parse(outcome.out);
  REQUIRE(table["entries"][0]["coefficients"].size() == 1);
  const auto volume = std::find_if(table["assumptions"].begin(), table["assumptions"].end(),
                                   [](const json& a) { return a["name"] == "total_volume_m3"; });
  REQUIRE(volume != table["assumptions"].end());
  CHECK_THAT((*volume)["value"].get<double>(), WithinRel(4.68e-3, 1e-12));
  CHECK((*volume)["source"] == "--set");
}

TEST_CASE("leak-table: of a fitted rig, whatever the campaign assumes", "[apps]") {
  const CommandFolder folder;
  const std::string assumed =
      "[leak_table.assumptions]\nvalve_gain = { value = \"5e-5 m/V\", source = \"a guess\" }\n";
  folder.write("campaign.toml",
               edited(kCampaign, {{"1000 V/m", "300 V/m"}}) + assumed + kSynthetic);
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made", "--quiet"})
              .exit_code == 0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
  const auto table = [&](const std::string& campaign, const CommandFolder::Arguments& more) {
    CommandFolder::Arguments arguments{"leak-table", campaign,       "--targets", "10,30",
                                       "--signals",  "sine@2Hz@5mm", "--out",     "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = folder.run(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    json result = json::parse(folder.read("out/leak_table.json"));
    CHECK(violations(result, "leak_table") == "");
    return std::pair(outcome.out, result);
  };
  const json fit = json::parse(folder.read("fit/fit.json"));
  const auto gain = std::find_if(fit["parameters"].begin(), fit["parameters"].end(),
                                 [](const json& p) { return p["name"] == "valve_gain_m_per_v"; });
  REQUIRE(gain != fit["parameters"].end());

  const auto [text, fitted] = table("made/campaign.toml", {"--fit", "fit/fit.json"});
  const auto used = std::find_if(fitted["assumptions"].begin(), fitted["assumptions"].end(),
                                 [](const json& a) { return a["key"] == "valve_gain"; });
  CHECK((*used)["value"] == (*gain)["value"]);
  CHECK_THAT((*used)["source"].get<std::string>(), Contains("in place of 5e-05 m/V (a guess)"));
  CHECK_THAT(text, Contains("The table uses valve_gain, damping from the fit") && Contains("±"));
  for (const json& entry : fitted["entries"]) {
    const double c = entry["coefficients"].at(0).get<double>();
    const json& range = entry["coefficients_ci95"].at(0);
    CHECK(range[0].get<double>() < c);
    CHECK(c < range[1].get<double>());
  }
  CHECK_THAT(folder.read("out/report.html"), Contains("from the fit") && Contains("<small>±"));
  CHECK_THAT(folder.read("out/leak_table.csv"), Contains("ci95_low,ci95_high"));

  // With the same file but without the fit, the guess is used and a warning says so.
  const auto [warned, guessed] = table("fit/fitted.toml", {});
  CHECK(guessed["entries"][0]["coefficients_ci95"][0].is_null());
  CHECK(guessed["entries"][0]["coefficients"] != fitted["entries"][0]["coefficients"]);
  CHECK_THAT(warned, Contains("warning: [leak_table.assumptions] replace") &&
                         Contains("valve_gain (50 µm/V for") && Contains("--fit"));
  // fitted.toml together with the fit gives the same table.
  const auto [again, same] = table("fit/fitted.toml", {"--fit", "fit/fit.json"});
  CHECK(same["entries"] == fitted["entries"]);

  // A value changed with --set does not come from the fit, and other known values make a different
  // rig.
  const auto [changed, other] =
      table("made/campaign.toml", {"--fit", "fit/fit.json", "--set", "valve_gain=0.05 mm/V",
                                   "--set", "damping=1000 N s/m", "--set", "mass=70 kg"});
  CHECK_THAT(changed, Contains("valve_gain: the value of the fit is not used (--set)") &&
                          Contains("mass is 70 kg here (assumption: --set), but the fit was made"));
  CHECK(other["entries"][0]["coefficients_ci95"][0].is_null());
}

TEST_CASE("leak-table: position and flows at each level are drawn", "[apps]") {
  const CommandFolder folder;
  write_rig(folder,
            "[leak_table]\n[leak_table.features]\nwaveform = \"sine\"\nfrequency = \"2 Hz\"\n"
            "amplitude = \"5 mm\"\n[[leak_table.features.row]]\nlevel = \"needle open\"\n"
            "coefficient = 0.3\n");
  REQUIRE(folder
              .run({"leak-table", "campaign.toml", "--targets", "10", "--signals", "sine@2Hz@5mm",
                    "--out", "out"})
              .exit_code == 0);
  const std::string page = folder.read("out/report.html");
  const json feature = json::parse(folder.read("out/leak_table.json"))["features"][0];
  const double percent = 100.0 * feature["leak_flow_l_per_min"].get<double>() /
                         feature["servo_flow_l_per_min"].get<double>();
  std::ostringstream share;
  share << "needle open: " << std::setprecision(3) << percent << " % of the servo flow leak";
  CHECK_THAT(page, Contains(share.str()) && Contains("Position in percent of the amplitude"));
  REQUIRE(folder.run({"report", "out", "--figures"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
  CHECK_THAT(folder.read("out/figures/leak_positions.svg"),
             Contains("needle open") && Contains("% of the amplitude"));
  CHECK_THAT(folder.read("out/figures/leak_flows_needle_open.svg"),
             Contains(">servo<") && Contains(">work<") && Contains(">leakage<") &&
                 Contains("flow [L/min]"));
  CHECK(folder.has("out/figures/leak_flows_needle_open.pdf"));
}

TEST_CASE("leak-table: a share out of reach is told, with what it gets to", "[apps]") {
  const CommandFolder folder;
  write_rig(folder, "[leak_table]\ncoefficients = [0.001, 0.01]\n");
  const Outcome outcome =
      folder.run({"leak-table", "campaign.toml", "--targets", "50", "--signals", "sine@2Hz@5mm",
                  "--set", "output_limit=0.5 V", "--out", "out"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out,
             Contains("not reached: at most") && Contains("valve command is at its limit"));
  const json table = json::parse(folder.read("out/leak_table.json"));
  CHECK(table["entries"][0]["coefficients"].empty());
  CHECK_THAT(table["entries"][0]["note"].get<std::string>(), Contains("not reached"));
}

TEST_CASE("leak-table: bad input is refused before any work", "[apps]") {
  const CommandFolder folder;
  write_rig(folder);
  check_refused(folder, {"leak-table"}, "CAMPAIGN");
  check_refused(folder, {"leak-table", "none.toml"}, "none.toml");
  check_refused(folder, {"leak-table", "campaign.toml", "--fit", "none.json"}, "none.json");
  check_refused(folder, {"leak-table", "campaign.toml", "--targets", "0"}, "targets");
  check_refused(folder, {"leak-table", "campaign.toml", "--targets", "ten"}, "targets");
  check_refused(folder, {"leak-table", "campaign.toml", "--signals", "saw@1Hz"}, "saw");
  check_refused(folder, {"leak-table", "campaign.toml", "--signals", "sine@3Hz"},
                "differ in amplitude");
  check_refused(folder, {"leak-table", "campaign.toml", "--set", "leakage_area=0 m2"},
                "leakage_area is zero");
  check_refused(folder, {"leak-table", "campaign.toml", "--set", "residual_scale=1 kg"},
                "residual_scale");
  folder.write("campaign.toml", kCampaign + "[leak_table]\ntarget = [10]\n");
  check_refused(folder, {"leak-table", "campaign.toml"}, "did you mean 'targets'");
  check_refused(folder, {"check", "campaign.toml"}, "did you mean 'targets'");
}

TEST_CASE("leak-table: what cannot be simulated is no table", "[apps]") {
  const CommandFolder folder;
  write_rig(folder, "[simulation]\nmax_seconds = 1e-6\n");
  const Outcome outcome = folder.run({"leak-table", "campaign.toml", "--out", "out"});
  CHECK(outcome.exit_code == 3);
  CHECK_THAT(outcome.err, Contains("leakage_coefficient = ") && Contains("out of time"));
  CHECK_FALSE(folder.has("out/leak_table.json"));
}

TEST_CASE("fit-tables: finds the values behind tables that leak-table made", "[apps]") {
  const CommandFolder folder;
  write_rig(folder);
  REQUIRE(folder
              .run({"leak-table", "campaign.toml", "--targets", "10,30", "--signals",
                    "sine@2Hz@5mm", "--out", "truth", "--quiet"})
              .exit_code == 0);
  const json truth = json::parse(folder.read("truth/leak_table.json"));
  const auto coefficient = [&](std::size_t i) {
    return fmt_number(truth["entries"][i]["coefficients"][0].get<double>());
  };
  // Flows of the true rig, computed by the leak table itself.
  const std::string guess = edited(
      kTables, {{"C10", coefficient(0)}, {"C30", coefficient(1)}, {"QS", "1e-5"}, {"QL", "1e-6"}});
  folder.write("flows.toml", kCampaign + guess);
  REQUIRE(folder.run({"leak-table", "flows.toml", "--out", "flows", "--quiet"}).exit_code == 0);
  const json flows = json::parse(folder.read("flows/leak_table.json"))["features"][0];
  const auto flow = [&](const char* key) { return fmt_number(flows[key].get<double>() / 60e3); };
  folder.write("campaign.toml", kCampaign + edited(kTables, {{"C10", coefficient(0)},
                                                             {"C30", coefficient(1)},
                                                             {"QS", flow("servo_flow_l_per_min")},
                                                             {"QL", flow("leak_flow_l_per_min")}}));
  const Outcome outcome = folder.run({"fit-tables", "campaign.toml", "--out", "out"});
  CAPTURE(outcome.err, outcome.out);
  REQUIRE(outcome.exit_code == 0);
  const json fit = json::parse(folder.read("out/fit.json"));
  CHECK(violations(fit, "result") == "");
  json broken = fit;
  broken.erase("residuals");
  CHECK_FALSE(violations(broken, "result").empty());
  broken = fit;
  broken["of"] = "hearsay";
  CHECK_FALSE(violations(broken, "result").empty());
  CHECK(fit["status"] == "converged");
  CHECK(fit["residual_count"] == 4);
  CHECK(violations(json::parse(folder.read("out/leak_table.json")), "leak_table") == "");
  // The page shows both results: the fitted values, and the resulting table with its grades.
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("<title>FITTED") && Contains("leakage_area") &&
                       Contains("id=\"leak-table\"") && Contains("class=\"cell good\""));
  REQUIRE(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
  REQUIRE(fit["parameters"].size() == 2);
  // The flows are accurate to a few 1e-4.
  CHECK_THAT(fit["parameters"][0]["value"].get<double>(), WithinRel(1000.0, 0.01));
  CHECK_THAT(fit["parameters"][1]["value"].get<double>(), WithinRel(1e-6, 0.01));
  CHECK(fit["parameters"][1]["name"] == "leakage_area_m2");
  // The fitted.toml that it writes gives the same table.
  REQUIRE(folder.run({"leak-table", "out/fitted.toml", "--out", "again", "--quiet"}).exit_code ==
          0);
  CHECK(json::parse(folder.read("again/leak_table.json"))["entries"] ==
        json::parse(folder.read("out/leak_table.json"))["entries"]);
  // Another fit to the same numbers can be compared with it.
  REQUIRE(folder.run({"fit-tables", "campaign.toml", "--free", "kp", "--out", "one", "--quiet"})
              .exit_code == 0);
  REQUIRE(folder.run({"compare", "out", "one", "--out", "both"}).exit_code == 0);
  const json compared = json::parse(folder.read("both/comparison.json"));
  CHECK(violations(compared, "comparison") == "");
  CHECK(compared["parameters"][0]["differences"][1]["significant"].is_null());
  CHECK_THAT(folder.read("both/report.html"),
             Contains("the same published numbers") && !Contains("id=\"scores\""));
}

TEST_CASE("fit-tables: bad input is refused", "[apps]") {
  const CommandFolder folder;
  write_rig(folder);
  check_refused(folder, {"fit-tables", "campaign.toml"}, "no assumption of [leak_table]");
  check_refused(folder, {"fit-tables", "campaign.toml", "--free", "kp"},
                "0 published numbers cannot determine 1 values");
  check_refused(folder, {"fit-tables", "campaign.toml", "--free", "kpp"}, "did you mean 'kp'");
}
