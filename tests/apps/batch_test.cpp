#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

namespace {

constexpr std::array kRigs{"bench_1", "lab/bench_2", "lab/bench_3"};

/// Writes records of three rigs, each to its own folder below `where`. The leak of lab/bench_2 is
/// different.
void write_rigs(const CommandFolder& folder, const std::string& where, const std::string& date,
                const std::string& leak) {
  for (const std::string rig : kRigs) {
    const Edits fitted{
        {"leakage_coefficient = 0.3",
         "leakage_coefficient = { start = 0.3, lower = 0.01, upper = 5.0, fit = true }"},
        {"use = \"fit\"", "date = " + date + "\nuse = \"fit\""}};
    const std::string own = rig == "lab/bench_2" ? leak : "0.3";
    folder.write(
        "truth.toml",
        edited(kCampaign, fitted) +
            edited(kSynthetic, {{"3e-5 m/V\"", "3e-5 m/V\", leakage_coefficient = " + own}}));
    REQUIRE(folder
                .run({"synthesize", "truth.toml", "--seed", date.substr(5, 2) + rig.back(), "--out",
                      where + "/" + rig, "--quiet"})
                .exit_code == 0);
  }
}

json batch_of(const CommandFolder& folder, const std::string& out) {
  return json::parse(folder.read(out + "/batch.json"));
}

/// Returns the process of a fit that works in a folder, or 0 if there is none.
pid_t fitting_process(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    if (text_of(entry.path() / "cmdline").rfind(std::string("rigcal\0fit\0", 11), 0) != 0) continue;
    std::error_code ended;
    if (std::filesystem::equivalent(entry.path() / "cwd", folder, ended))
      return std::stoi(entry.path().filename().string());
  }
  return 0;
}

json without_run(json fit) {
  fit.erase("wall_seconds");
  fit["provenance"].erase("command");
  fit["provenance"].erase("files");  // report.html and other files contain the command
  return fit;
}

}  // namespace

TEST_CASE("batch: every rig as fit fits it, and one overview", "[apps]") {
  const CommandFolder folder;
  write_rigs(folder, "lab_a", "2026-03-01", "0.5");
  const Outcome outcome = folder.run({"batch", "lab_a", "--out", "out", "--jobs", "2"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("3 rigs: ") && Contains("lab/bench_2"));
  CHECK_THAT(outcome.err, Contains("3 of 3 rigs: "));

  const json batch = batch_of(folder, "out");
  CHECK(violations(batch, "batch") == "");
  REQUIRE(batch["rigs"].size() == 3);
  for (std::size_t i = 0; i < kRigs.size(); ++i) {
    const std::string rig = kRigs[i];
    CAPTURE(rig);
    const json& row = batch["rigs"][i];
    CHECK(row["rig"] == rig);
    CHECK(row["unchanged"] == false);
    CHECK(row["seconds"].get<double>() > 0.0);
    folder.run({"fit", "lab_a/" + rig + "/campaign.toml", "--out", "alone", "--quiet"});
    const json alone = json::parse(folder.read("alone/fit.json"));
    const json fit = json::parse(folder.read("out/" + rig + "/fit.json"));
    CHECK(without_run(fit) == without_run(alone));
    CHECK(row["verdict"] == alone["verdict"]);
    for (const json& estimate : row["parameters"]) {
      for (const json& parameter : alone["parameters"]) {
        if (parameter["name"] == estimate["name"]) CHECK(parameter["ci95"] == estimate["ci95"]);
      }
    }
    // Every verdict other than PASS has a reason.
    CHECK(row["reasons"].empty() == (row["verdict"] == "PASS"));
  }
  const std::string csv = folder.read("out/batch.csv");
  CHECK_THAT(csv, Contains("leakage_coefficient_ci95_low") && Contains("\nlab/bench_3,"));
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("href=\"lab/bench_2/report.html\""));
  REQUIRE(folder.run({"report", "out"}).exit_code == 0);
  CHECK(folder.read("out/report.html") == page);
}

TEST_CASE("batch: a second one makes only what has changed", "[apps]") {
  const CommandFolder folder;
  write_rigs(folder, "lab_a", "2026-03-01", "0.5");
  REQUIRE(folder.run({"batch", "lab_a", "--out", "out", "--quiet"}).exit_code == 0);
  const std::string first = folder.read("out/bench_1/fit.json");
  folder.write(
      "lab_a/lab/bench_2/campaign.toml",
      replaced(folder.read("lab_a/lab/bench_2/campaign.toml"), "rho2 = 0.9", "rho2 = 0.95"));
  // A missing or modified file of a result causes the result to be made again.
  std::filesystem::remove(folder.work() / "out/lab/bench_3/scorecard.csv");
  REQUIRE(folder.run({"batch", "lab_a", "--out", "out", "--resume", "--quiet"}).exit_code == 0);
  const json batch = batch_of(folder, "out");
  CHECK(batch["rigs"][0]["unchanged"] == true);
  CHECK(batch["rigs"][1]["unchanged"] == false);
  CHECK(batch["rigs"][2]["unchanged"] == false);
  CHECK(folder.read("out/bench_1/fit.json") == first);
  CHECK(folder.has("out/lab/bench_3/scorecard.csv"));
  // The additional option requests other intervals, so the fit is repeated.
  REQUIRE(folder.run({"batch", "lab_a", "--out", "out", "--resume", "--profiles", "--quiet"})
              .exit_code == 0);
  CHECK(batch_of(folder, "out")["rigs"][0]["unchanged"] == false);
  CHECK_THAT(folder.read("out/bench_1/fit.json"), Contains("\"profile\""));
}

TEST_CASE("batch: a leak that grows is a significant trend of its rig alone", "[apps][long]") {
  const CommandFolder folder;
  folder.write("none", "");
  std::vector<std::string> last{"batch", "month_4", "--out", "out_4", "--diagnose"};
  for (int month = 1; month <= 4; ++month) {
    const std::string number = std::to_string(month);
    write_rigs(folder, "month_" + number, "2026-0" + number + "-01",
               "0." + std::to_string(2 + month));
    if (month == 4) break;
    REQUIRE(
        folder.run({"batch", "month_" + number, "--out", "out_" + number, "--quiet"}).exit_code ==
        0);
    last.insert(last.end(), {"--earlier", "out_" + number});
  }
  const Outcome outcome = folder.run(last);
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("lab/bench_2: leakage_coefficient: +"));
  const json batch = batch_of(folder, "out_4");
  CHECK(violations(batch, "batch") == "");
  CHECK(batch["provenance"]["inputs"].size() == 12);  // 3 x (the campaign and 3 earlier results)
  for (const json& row : batch["rigs"]) {
    for (const json& trend : row["trends"]) {
      CAPTURE(row["rig"], trend["key"]);
      REQUIRE(trend["series"]["points"].size() == 4);
      if (trend["key"] == "leakage_coefficient" && row["rig"] == "lab/bench_2") {
        CHECK(trend["series"]["along_date"]["significant"] == true);
        // The coefficient changes by 0.3 in 92 days.
        CHECK(trend["series"]["along_date"]["slope_per_day"].get<double>() ==
              Approx(0.3 / 92.0).epsilon(0.15));
      }
    }
    CHECK(folder.has("out_4/" + row["rig"].get<std::string>() + "/diagnosis.json"));
  }
  CHECK_THAT(folder.read("out_4/report.html"), Contains("significant trend"));
}

TEST_CASE("batch: one rig that fails does not hide, and does not stop the others", "[apps]") {
  const CommandFolder folder;
  write_rigs(folder, "lab_a", "2026-03-01", "0.5");
  folder.write("lab_a/bench_1/campaign.toml", replaced(folder.read("lab_a/bench_1/campaign.toml"),
                                                       "use = \"fit\"", "use = \"fid\""));
  std::filesystem::create_directories(folder.work() / "out/lab/bench_2/fit.json");
  std::filesystem::create_symlink("loop", folder.work() / "lab_a/loop");
  const Outcome outcome = folder.run({"batch", "lab_a", "--out", "out"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 5);
  const json batch = batch_of(folder, "out");
  CHECK(violations(batch, "batch") == "");
  CHECK(batch["rigs"][0]["status"].is_null());
  CHECK_THAT(batch["rigs"][0]["message"].get<std::string>(),
             Contains("campaign.toml:") && Contains("fid"));
  CHECK(batch["rigs"][0]["exit_code"] == 2);
  CHECK(batch["rigs"][1]["exit_code"] == 5);
  CHECK_THAT(batch["rigs"][1]["message"].get<std::string>(), Contains("fit.json"));
  CHECK(batch["rigs"][2]["status"] == "converged");
  CHECK_THAT(outcome.out, Contains("2 no result") && Contains("bench_1: ") && Contains("fid"));
  CHECK_THAT(folder.read("out/report.html"), Contains("INCOMPLETE"));
}

TEST_CASE("batch: a signal ends it with what is done, and --resume makes the rest", "[apps]") {
  const CommandFolder folder;
  write_rigs(folder, "lab_a", "2026-03-01", "0.5");
  const Outcome stopped = folder.run_and_signal(
      {"batch", "lab_a", "--out", "out", "--bootstrap", "5000"}, "of 3 rigs", SIGTERM);
  CAPTURE(stopped.out, stopped.err);
  // If a rig took longer than the time until the signal, it was stopped or not started.
  if (stopped.exit_code != 0) {
    CHECK(stopped.exit_code == 4);
    CHECK(batch_of(folder, "out")["status"] == "stopped");
  }
  REQUIRE(folder.run({"batch", "lab_a", "--out", "out", "--resume", "--quiet"}).exit_code == 0);
  CHECK(batch_of(folder, "out")["status"] == "done");
}

TEST_CASE("batch: a signal stops the fit that runs", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const Outcome outcome = folder.run_and_signal_at(
      {"batch", "twin", "--out", "out", "--bootstrap", "1000000", "--max-time", "30"},
      "out/twin/checkpoint.tasks", SIGTERM);
  CHECK(outcome.exit_code == 4);
  const json row = batch_of(folder, "out")["rigs"][0];
  CHECK(row["status"] == "stopped");
  CHECK_THAT(row["message"].get<std::string>(), Contains("on request"));  // not by the time limit
}

TEST_CASE("batch: a rig whose process is killed has no result, and the row says why", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  auto batch = std::async(std::launch::async, [&] {
    return folder.run(
        {"batch", "twin", "--out", "out", "--bootstrap", "1000000", "--max-time", "30", "--quiet"});
  });
  pid_t fit = 0;
  while (fit == 0 && batch.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready)
    fit = fitting_process(folder.work());
  REQUIRE(fit > 0);
  ::kill(fit, SIGKILL);
  CHECK(batch.get().exit_code == 5);
  const json row = batch_of(folder, "out")["rigs"][0];
  CHECK(row["exit_code"] == 5);
  CHECK(row["status"].is_null());
  CHECK_THAT(row["message"].get<std::string>(), Contains("signal 9"));
}

TEST_CASE("batch: what it refuses", "[apps]") {
  const CommandFolder folder;
  write_rigs(folder, "lab_a", "2026-03-01", "0.5");
  std::filesystem::create_directories(folder.work() / "empty");
  Outcome outcome = folder.run({"batch", "empty", "--out", "out"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("found no campaign.toml beneath empty"));
  CHECK_FALSE(folder.has("out"));
  outcome = folder.run({"batch", "nowhere", "--out", "out"});
  CHECK(outcome.exit_code == 2);
  std::filesystem::create_directories(folder.work() / "out");
  outcome = folder.run({"batch", "lab_a", "--out", "out", "--earlier", "out"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("--earlier out is the folder of the new results"));
  outcome = folder.run({"batch", "lab_a", "--out", "out", "--jobs", "0"});
  CHECK(outcome.exit_code == 2);
}
