#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/cli_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

namespace {

json batch_in(const CommandFolder& folder, const std::string& out) {
  return json::parse(folder.read(out + "/batch.json"));
}

/// Runs a batch with --resume, and returns the row of its first rig.
json resumed_row(const CommandFolder& folder, const CommandFolder::Arguments& options) {
  CommandFolder::Arguments batch{"batch", "twin", "--out", "out", "--resume", "--force", "--quiet"};
  batch.insert(batch.end(), options.begin(), options.end());
  folder.run(batch);
  return batch_in(folder, "out")["rigs"][0];
}

}  // namespace

TEST_CASE("batch: every folder with a campaign is a rig, but for those among the results",
          "[apps]") {
  const CommandFolder folder;
  const std::string none = "schema = \"rigcal.campaign/1\"\n";  // the verb rejects it immediately
  for (const char* where : {"lab/z", "lab/a/deep", "lab", "lab/out/earlier"})
    folder.write(std::string(where) + "/campaign.toml", none);
  folder.write("lab/a/campaign.toml.bak", none);
  // A result from an earlier run must not be taken for the result of a rejected rig.
  folder.write("lab/out/z/fit.json", "{}");
  const Outcome outcome = folder.run({"batch", "lab", "--out", "lab/out", "--quiet"});
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.empty());
  const json batch = batch_in(folder, "lab/out");
  CHECK(batch["exit_code"] == 2);
  std::vector<std::string> rigs;
  for (const json& row : batch["rigs"]) {
    rigs.push_back(row["rig"]);
    CHECK(row["exit_code"] == 2);
    CHECK(row["status"].is_null());
    CHECK(row["unchanged"] == false);
    CHECK_THAT(row["message"].get<std::string>(),
               Contains("campaign.toml") && !Contains("rigcal: "));
  }
  CHECK(rigs == std::vector<std::string>{"a/deep", "lab", "z"});
}

TEST_CASE("batch: the options of a fit reach every rig, and its exit code comes back", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"rho2 = 0.9", "rho2 = 0.999999999"}}).exit_code == 0);
  const Outcome outcome = folder.run({"batch", "twin", "--out", "out", "--starts", "2", "--seed",
                                      "9", "--diagnose", "--max-evaluations", "100000", "--quiet"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 1);
  const json batch = batch_in(folder, "out");
  REQUIRE(batch["rigs"].size() == 1);
  const json& row = batch["rigs"][0];
  CHECK(row["rig"] == "twin");
  CHECK(row["verdict"] == "FAIL");
  CHECK(row["exit_code"] == 1);
  const json fit = json::parse(folder.read("out/twin/fit.json"));
  CHECK(fit["starts"].size() == 2);
  CHECK(fit["provenance"]["seed"] == 9);
}

TEST_CASE("batch: --resume keeps a result of the same seed whose files are as written", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  CHECK(resumed_row(folder, {})["unchanged"] == false);
  CHECK(resumed_row(folder, {})["unchanged"] == true);
  CHECK(resumed_row(folder, {"--seed", "9"})["unchanged"] == false);
  const std::string scores = folder.read("out/twin/scorecard.csv");
  folder.write("out/twin/scorecard.csv", scores + "edited\n");
  CHECK(resumed_row(folder, {"--seed", "9"})["unchanged"] == false);
  CHECK(folder.read("out/twin/scorecard.csv") == scores);
}

TEST_CASE("batch: --resume goes on with the fit that was stopped, and refuses another", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(resumed_row(folder, {"--starts", "3", "--max-evaluations", "20"})["status"] == "stopped");
  const json other = resumed_row(folder, {"--starts", "3", "--seed", "9"});
  CHECK(other["exit_code"] == 2);
  CHECK_THAT(other["message"].get<std::string>(), Contains("checkpoint of another fit"));
  CHECK(resumed_row(folder, {"--starts", "3"})["status"] == "converged");
}

TEST_CASE("batch: an earlier result that cannot be read is told, and the report is linked",
          "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  std::filesystem::create_directories(folder.work() / "lab");
  std::filesystem::rename(folder.work() / "twin", folder.work() / "lab/bench #1");
  folder.write("earlier/bench #1/fit.json", "{}");
  REQUIRE(
      folder.run({"batch", "lab", "--out", "out", "--earlier", "earlier", "--quiet"}).exit_code ==
      0);
  CHECK_THAT(batch_in(folder, "out")["rigs"][0]["warnings"].dump(),
             Contains("left out: earlier/bench #1/fit.json"));
  // In an address, # would begin the name of a place in the page.
  CHECK_THAT(folder.read("out/report.html"), Contains("href=\"bench%20%231/report.html\""));
}

TEST_CASE("batch: with --diagnose what a diagnosis refuses is told as such", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"leak_level = \"none\"\nuse = \"fit\"", "use = \"fit\""},
                              {"leak_level = \"none\"\nuse = \"validate\"", "use = \"validate\""}})
              .exit_code == 0);
  const Outcome outcome = folder.run({"batch", "twin", "--out", "out", "--diagnose", "--quiet"});
  const json row = batch_in(folder, "out")["rigs"][0];
  CHECK(row["status"] == "converged");
  const Outcome alone = folder.run({"diagnose", "twin/campaign.toml", "--fit", "out/twin/fit.json",
                                    "--out", "alone", "--quiet"});
  CHECK(outcome.exit_code == alone.exit_code);
  if (alone.exit_code != 0) {
    CHECK_THAT(row["message"].get<std::string>(), Contains("diagnose: "));
  }
}

TEST_CASE("fit: WARN is exit 1 with --strict alone, in a batch too", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"use = \"validate\"", "use = \"ignore\""}}).exit_code == 0);
  const Outcome plain = folder.run({"fit", "twin/campaign.toml", "--out", "plain", "--quiet"});
  REQUIRE(json::parse(folder.read("plain/fit.json"))["verdict"] ==
          "WARN");  // because it was not validated
  CHECK(plain.exit_code == 0);
  CHECK(folder.run({"fit", "twin/campaign.toml", "--out", "strict", "--strict", "--quiet"})
            .exit_code == 1);
  CHECK(folder.run({"batch", "twin", "--out", "batch", "--quiet"}).exit_code == 0);
  CHECK(folder.run({"batch", "twin", "--out", "again", "--strict", "--quiet"}).exit_code == 1);
}

TEST_CASE("fit: options that make no sense are refused before any work", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const auto exit_code = [&](const std::string& option, const std::string& value) {
    return folder.run({"fit", "campaign.toml", "--out", "out", option, value, "--quiet"}).exit_code;
  };
  for (const char* seconds : {"0", "-1", "nan", "inf", "-inf", "1e999", "x", ""})
    CHECK(exit_code("--max-time", seconds) == 2);
  for (const char* seed : {"-1", "5x", "1.5", "", "18446744073709551616", " 5"})
    CHECK(exit_code("--seed", seed) == 2);
  for (const char* count : {"0", "-1", "5x", "1e3"})
    CHECK(exit_code("--max-evaluations", count) == 2);
  for (const char* count : {"0", "-1", "x"}) {
    CHECK(exit_code("--starts", count) == 2);
    CHECK(exit_code("--threads", count) == 2);
  }
  CHECK_FALSE(folder.has("out"));
  // The smallest valid value of each option is accepted. A limit of one evaluation stops the fit,
  // but is not rejected.
  CHECK(folder
            .run({"fit", "campaign.toml", "--out", "out", "--seed", "0", "--max-evaluations", "1",
                  "--threads", "1", "--starts", "1", "--max-time", "60", "--quiet"})
            .exit_code != 2);
  // So is the largest seed, 2^64 - 1.
  CHECK(folder
            .run({"fit", "campaign.toml", "--out", "out", "--seed", "18446744073709551615",
                  "--max-evaluations", "1", "--quiet"})
            .exit_code != 2);
}
