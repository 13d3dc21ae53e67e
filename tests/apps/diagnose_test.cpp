#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

using namespace rigcal::test;
using Catch::Contains;
using Catch::StartsWith;
using nlohmann::json;

namespace {

/// One healthy and one leaking condition with the same sine.
const std::string kDiagnosed =
    edited(kCampaign, {{"1000 V/m", "300 V/m"},  // otherwise the healthy loop would oscillate
                       {"leakage_coefficient = 0.3", "leakage_coefficient = 0"},
                       {"[leak_level.\"none\"]",
                        "[leak_level.\"none\"]\nparameters = { leakage_coefficient = 0 }\n"
                        "[leak_level.\"open\"]\nparameters = { leakage_coefficient = 0.15 }\n"},
                       {"id = \"square\"\nwaveform = \"square\"\nfrequency = \"1 Hz\"\n"
                        "amplitude = \"4 mm\"\nleak_level = \"none\"\nuse = \"validate\"\n"
                        "repeats = [\"records/square_*.csv\"]",
                        "id = \"leaking\"\nwaveform = \"sine\"\nfrequency = \"2 Hz\"\n"
                        "amplitude = \"5 mm\"\nleak_level = \"open\"\nuse = \"diagnose\"\n"}});

}  // namespace

TEST_CASE("diagnose: from synthetic records to classes", "[apps]") {
  const CommandFolder folder;
  folder.write(
      "campaign.toml",
      kDiagnosed + edited(kSynthetic, {{"position = \"0.01 mm\"", "position = \"0.05 mm\""},
                                       {"\"0.05 bar\"", "\"1 bar\""}}));
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made"}).exit_code ==
          0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit"}).exit_code == 0);
  const Outcome outcome =
      folder.run({"diagnose", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "diagnosis"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("leaking") && Contains("Smallest leak"));
  const json result = json::parse(folder.read("diagnosis/diagnosis.json"));
  CHECK(result["status"] == "done");
  REQUIRE(result["records"].size() == 8);  // two averages and their three repeats each
  for (const json& record : result["records"]) {
    CAPTURE(record.dump());
    CHECK(record["failure"].is_null());
    CHECK_FALSE(record["undecided"].get<bool>());
    const bool is_healthy_mean = record["condition"] == "sine" && record["repeat"].is_null();
    CHECK(record["is_reference"] == is_healthy_mean);
    if (is_healthy_mean) {  // its leak is zero by construction
      CHECK(record["leak_detected"].is_null());
      CHECK(record["ci95"].is_null());
      CHECK(record["class"].is_null());
      continue;
    }
    CHECK(record["class"] == record["true_class"]);
    CHECK(record["ci95"][0] <= record["leakage_coefficient"]);
    CHECK(record["leakage_coefficient"] <= record["ci95"][1]);
    CHECK(record["ci95"][1] > 0.0);
  }
  REQUIRE(result["states"].size() == 2);
  CHECK(result["states"][0]["is_reference"] == true);
  const json& leaking = result["states"][1];
  CHECK(leaking["state"] == "open");
  CHECK(leaking["class"] == "slight");
  CHECK(leaking["ci95"][0] < 0.15);
  CHECK(leaking["ci95"][1] > 0.15);
  CHECK_THAT(outcome.out, Contains("State of the machine") && Contains("open: "));
  CHECK(result["accuracy"] == 1.0);
  CHECK(result["confusion"]["counts"][0][0] == 3);
  // The detection limit for the mean of three is below that for one repeat, but of the same order.
  const json& smallest = result["smallest_leak_l_per_min"][0];
  CHECK(smallest["averaged"].get<double>() > 0.2 * smallest["single"].get<double>());
  CHECK_THAT(outcome.out, Contains("another day than their reference") &&
                              Contains("Between days the rig may differ"));
  const json& between_days = result["between_days"];
  CHECK(between_days["source"] == "usual");
  CHECK(between_days["quantities"].size() == 4);
  REQUIRE(between_days["other_days"].size() == 1);  // the leaking record, which has no date
  CHECK(smallest["of_another_day"] == true);
  CHECK(smallest["averaged_same_day"].get<double>() < smallest["averaged"].get<double>());
  CHECK_THAT(folder.read("diagnosis/diagnosis.csv"), StartsWith("condition,repeat,signal,"));
  CHECK(violations(result, "diagnosis") == "");
  // This file contains the rig for the page, with the leak found in each average, largest leak
  // first. The result refers to the file by name.
  const json live = json::parse(folder.read("diagnosis/diagnosis_live.json"));
  REQUIRE(!live["cases"].empty());
  CHECK(live["cases"][0]["name"] == "leaking");
  CHECK(live["cases"][0]["measured"].size() == 2);
  CHECK(live["intervals"][0]["level"] == "leaking");
  const auto estimate =
      *std::find_if(result["records"].begin(), result["records"].end(), [](const json& record) {
        return record["condition"] == "leaking" && record["repeat"].is_null();
      });
  CHECK(live["intervals"][0]["low"] == estimate["ci95"][0]);
  CHECK(live["intervals"][0]["high"] == estimate["ci95"][1]);
  const json& named = result["provenance"]["files"];
  CHECK(std::any_of(named.begin(), named.end(),
                    [](const json& file) { return file["path"] == "diagnosis_live.json"; }));
  const std::string page = folder.read("diagnosis/report.html");
  CHECK_THAT(page, Contains("<title>LEAK") && Contains("id=\"diagnosis\"") &&
                       Contains("Comparison with the known classes"));
  REQUIRE(folder.run({"report", "diagnosis"}).exit_code == 0);
  CHECK(folder.read("diagnosis/report.html") == page);
}

TEST_CASE("diagnose: classes end where the rows of a leak table of the same rig do", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", kDiagnosed + kSynthetic);
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made", "--quiet"})
              .exit_code == 0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
  REQUIRE(folder
              .run({"leak-table", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "table",
                    "--targets", "3,6,9"})
              .exit_code == 0);
  const auto diagnosed = [&](const CommandFolder::Arguments& more) {
    CommandFolder::Arguments arguments{
        "diagnose", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return folder.run(arguments);
  };
  const Outcome outcome = diagnosed({"--table", "table/leak_table.json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("Limits of the classes, from the leak table") &&
                              Contains("       3  slight  ") && Contains("       9  critical  "));
  const json result = json::parse(folder.read("out/diagnosis.json"));
  CHECK(violations(result, "diagnosis") == "");
  CHECK_THAT(result["settings"]["limits_percent"]["critical"].get<double>(),
             Catch::WithinRel(9.0, 1e-12));
  // The class from the table's coefficient equals the class from the share.
  const json table = json::parse(folder.read("table/leak_table.json"));
  REQUIRE(result["class_limits"].size() == table["entries"].size());
  CHECK(result["class_limits"][0]["class"] == "slight");
  CHECK(result["class_limits"][0]["coefficients"] == table["entries"][0]["coefficients"]);
  for (const json& record : result["records"]) {
    if (record["condition"] != "leaking") continue;
    int rows_below = 0;
    for (const json& limit : result["class_limits"]) {
      if (limit["coefficients"].at(0) < record["leakage_coefficient"]) ++rows_below;
    }
    CAPTURE(record.dump());
    constexpr std::array kByRows{"slight", "medium", "critical", "supercritical"};
    CHECK(record["class"] == kByRows.at(static_cast<std::size_t>(rows_below)));
    CHECK(rows_below > 0);
  }
  CHECK_THAT(folder.read("out/report.html"),
             Contains("Limits of the classes, from the leak table"));

  // The leak table with the campaign's own values belongs to a different rig.
  REQUIRE(folder.run({"leak-table", "made/campaign.toml", "--out", "other", "--targets", "3,6,9"})
              .exit_code == 0);
  const Outcome other = diagnosed({"--table", "other/leak_table.json"});
  CHECK(other.exit_code == 2);
  CHECK_THAT(other.err,
             Contains("another rig: ") && Contains("valve_gain is 20 µm/V in the table"));
  const Outcome none = diagnosed({"--table", "fit/fit.json"});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.err, Contains("rigcal.leak_table/1"));
}

TEST_CASE("diagnose: the law of the leak is stated in the campaign and in the result", "[apps]") {
  const CommandFolder folder;
  const std::string laminar =
      edited(kDiagnosed, {{"leakage_coefficient = 0.15", "laminar_leakage = \"2e-11 m3/(s Pa)\""}});
  folder.write("campaign.toml", laminar +
                                    "[diagnosis]\nleak_law = \"laminar\"\n"
                                    "level_class = { none = \"normal\" }\n" +
                                    kSynthetic);
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made", "--quiet"})
              .exit_code == 0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
  const Outcome outcome =
      folder.run({"diagnose", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "out"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const json result = json::parse(folder.read("out/diagnosis.json"));
  CHECK(violations(result, "diagnosis") == "");
  CHECK(result["settings"]["leak_law"] == "laminar");
  REQUIRE(result["states"].size() == 2);
  const json& leaking = result["states"][1];
  CHECK(leaking["ci95"][0] < 2e-11);
  CHECK(leaking["ci95"][1] > 2e-11);
  CHECK(leaking["leak_area_m2"].is_null());
  CHECK_THAT(folder.read("out/report.html"), Contains("Conductance, m³/(s Pa)"));

  // The coefficients of a leak table are of an orifice.
  REQUIRE(folder
              .run({"leak-table", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "table",
                    "--targets", "3,6,9"})
              .exit_code == 0);
  const Outcome table = folder.run({"diagnose", "made/campaign.toml", "--fit", "fit/fit.json",
                                    "--out", "out", "--table", "table/leak_table.json"});
  CHECK(table.exit_code == 2);
  CHECK_THAT(table.err, Contains("leak_law") && Contains("orifice"));
}

TEST_CASE("diagnose: --healthy names the level that the campaign does not know", "[apps]") {
  const CommandFolder folder;
  folder.write(
      "campaign.toml",
      edited(kDiagnosed, {{"[leak_level.\"none\"]\nparameters = { leakage_coefficient = 0 }",
                           "[leak_level.\"none\"]"}}) +
          kSynthetic);
  REQUIRE(folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made", "--quiet"})
              .exit_code == 0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
  const auto diagnosed = [&](const CommandFolder::Arguments& more) {
    CommandFolder::Arguments arguments{
        "diagnose", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return folder.run(arguments);
  };
  const auto count_of = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      ++count;
    return count;
  };
  const Outcome unknown = diagnosed({});
  REQUIRE(unknown.exit_code == 0);
  // Both conditions lack a class. One line reports this, with the remedy.
  CHECK(count_of(unknown.out, "the interval does not include model error") == 1);
  CHECK_THAT(unknown.out, Contains("no healthy record of this signal") &&
                              Contains("--healthy LEVEL") && Contains("level_class"));
  const json without = json::parse(folder.read("out/diagnosis.json"));
  for (const json& record : without["records"]) {
    CHECK(record["reference_repeats"] == 0);
    CHECK_THAT(record["warnings"].dump(), Contains("no healthy record"));
  }

  const Outcome outcome = diagnosed({"--healthy", "none"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(count_of(outcome.out, "no healthy record") == 0);
  const json result = json::parse(folder.read("out/diagnosis.json"));
  CHECK(result["provenance"]["options"]["healthy"] == "none");
  for (const json& record : result["records"]) CHECK(record["reference_repeats"] > 0);
  CHECK(result["smallest_leak_l_per_min"][0]["averaged"].is_number());

  const Outcome wrong = diagnosed({"--healthy", "nome"});
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("--healthy") && Contains("did you mean 'none'"));
  folder.write("made/campaign.toml", folder.read("made/campaign.toml") +
                                         "\n[diagnosis]\nlevel_class = { none = \"slight\" }\n");
  const Outcome contradicted = diagnosed({"--healthy", "none"});
  CHECK(contradicted.exit_code == 2);
  CHECK_THAT(contradicted.err, Contains("says that \"none\" is slight"));
}

TEST_CASE("diagnose: a leak that grows from date to date", "[apps]") {
  const CommandFolder folder;
  std::string campaign =
      edited(kDiagnosed, {{"id = \"leaking\"", "id = \"march\"\ndate = 2026-03-01"},
                          {"amplitude = \"5 mm\"\nleak_level = \"open\"\nuse = \"diagnose\"",
                           "amplitude = \"5 mm\"\nuse = \"diagnose\"\n"
                           "parameters = { leakage_coefficient = 0.15 }\n"}});
  campaign += edited(kSynthetic, {{"position = \"0.01 mm\"", "position = \"0.05 mm\""},
                                  {"\"0.05 bar\"", "\"1 bar\""}});
  for (const auto& [id, date, leak] :
       {std::array{"april", "2026-04-01", "0.2"}, std::array{"may", "2026-05-01", "0.25"}}) {
    campaign += fmt::format(
        "[[condition]]\nid = \"{}\"\ndate = {}\nwaveform = \"sine\"\nfrequency = \"2 Hz\"\n"
        "amplitude = \"5 mm\"\nuse = \"diagnose\"\n"
        "parameters = {{ leakage_coefficient = {} }}\n",
        id, date, leak);
  }
  folder.write("campaign.toml", campaign);
  const Outcome made =
      folder.run({"synthesize", "campaign.toml", "--seed", "1", "--out", "made", "--quiet"});
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  REQUIRE(folder.run({"fit", "made/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
  const Outcome outcome =
      folder.run({"diagnose", "made/campaign.toml", "--fit", "fit/fit.json", "--out", "diagnosis"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("The machine: the leak rises by"));
  const json result = json::parse(folder.read("diagnosis/diagnosis.json"));
  CHECK(violations(result, "diagnosis") == "");
  REQUIRE(result["trends"].size() == 1);
  const json& trend = result["trends"][0];
  CHECK(trend["dates"] == 3);
  CHECK(trend["first_date"] == "2026-03-01");
  CHECK(trend["significant"] == true);
  // The coefficient changes by 0.1 in 61 days.
  CHECK(std::abs(trend["coefficient_per_day"].get<double>() * 61.0 - 0.1) < 0.01);
  CHECK_THAT(folder.read("diagnosis/report.html"), Contains("The machine: the leak rises by"));
}

TEST_CASE("diagnose: without a fit it is a wrong use", "[apps]") {
  const CommandFolder folder;
  folder.write("campaign.toml", kDiagnosed);
  const Outcome outcome = folder.run({"diagnose", "campaign.toml"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("--fit is missing"));
  CHECK_FALSE(folder.has("rigcal-out"));
}

TEST_CASE("diagnose: a seal defect in counts is declined with every reason", "[apps]") {
  const std::filesystem::path data =
      std::filesystem::path(RIGCAL_RECORDINGS_DIR) / "moog_flotork_rotary_seal_defect";
  const CommandFolder folder;
  const Outcome outcome =
      folder.run({"diagnose", RIGCAL_SOURCE_DIR "/datasets/rigs/moog_flotork/campaign.toml",
                  "--data", data.string(), "--out", "declined"});
  if (!std::filesystem::exists(data)) {
    WARN("skipped: no recordings at " << data);
    return;
  }
  CHECK(outcome.exit_code == 3);
  const json result = json::parse(folder.read("declined/diagnosis.json"));
  CHECK(result["status"] == "declined");
  const std::string reasons = result["reasons"].dump();
  for (const char* part : {"counts", "no channel command", "sampling rate", "specimen", "date"})
    CHECK_THAT(reasons, Contains(part));
  CHECK(result["records"].empty());
  CHECK_THAT(folder.read("declined/diagnosis.csv"), StartsWith("# status: declined: "));
  CHECK(violations(result, "diagnosis") == "");
  CHECK_THAT(folder.read("declined/report.html"),
             Contains("<title>DECLINED") && Contains("<body class=\"bad\">"));
}
