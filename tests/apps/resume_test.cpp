#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/apps/cli_fixture.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;

/// Returns fit.json without the parts that may differ between two runs.
nlohmann::json comparable(const CommandFolder& folder, const std::string& file) {
  auto json = nlohmann::json::parse(folder.read(file));
  json.erase("wall_seconds");
  json.erase("provenance");
  return json;
}

/// Writes a twin with bounds so narrow that every start is quick.
Outcome write_quick_twin(const CommandFolder& folder) {
  return write_twin(folder, {{R"(lower = "10 N s/m", upper = "1e5 N s/m")",
                              R"(lower = "500 N s/m", upper = "4e3 N s/m")"},
                             {R"(lower = "1e-6 m/V", upper = "1e-3 m/V")",
                              R"(lower = "1e-5 m/V", upper = "6e-5 m/V")"}});
}

}  // namespace

TEST_CASE("resume: a killed fit goes on to the result of one that was not", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  const CommandFolder::Arguments whole{
      "fit",     "twin/campaign.toml", "--starts", kSanitized ? "40" : "100", "--out", "whole",
      "--quiet", "--threads",          "1"};
  REQUIRE(folder.run(whole).exit_code == 0);
  CHECK_FALSE(folder.has("whole/checkpoint.json"));  // a completed fit needs no checkpoint

  CommandFolder::Arguments parts = whole;
  parts[5] = "parts";
  parts.back() = "2";  // the number of threads does not matter, either
  int killed = 0;
  for (const char* start : {"\"number\": 2", "\"number\": 10", "\"number\": 30"}) {
    killed += folder.run_and_kill(parts, "parts/checkpoint.json", start).exit_code == -SIGKILL;
    if (parts.back() != "--resume") parts.push_back("--resume");
  }
  CHECK(killed >= 1);
  REQUIRE(folder.run(parts).exit_code == 0);
  CHECK(comparable(folder, "parts/fit.json") == comparable(folder, "whole/fit.json"));
}

TEST_CASE("resume: a stopped fit keeps what it needs, and only the same fit takes it", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  CommandFolder::Arguments fit{"fit",   "twin/campaign.toml", "--starts", "5",      "--out",
                               "parts", "--max-evaluations",  "20",       "--quiet"};
  REQUIRE(folder.run(fit).exit_code == 4);
  REQUIRE(folder.has("parts/checkpoint.json"));
  CHECK_THAT(comparable(folder, "parts/fit.json")["message"].get<std::string>(),
             Contains("of 5 starts"));

  SECTION("another number of starts is another fit") {
    fit[3] = "6";
    fit.push_back("--resume");
    const Outcome outcome = folder.run(fit);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("checkpoint.json") && Contains("options"));
  }
  SECTION("a checkpoint that is none is named") {
    folder.write("parts/checkpoint.json", "{\"schema\": 1");
    fit.push_back("--resume");
    const Outcome outcome = folder.run(fit);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("checkpoint.json"));
  }
  SECTION("without the limit it ends as if it had never had one") {
    fit[7] = "1000000";
    fit.insert(fit.end(), {"--resume", "--if-changed"});  // a stopped fit is not whole
    REQUIRE(folder.run(fit).exit_code == 0);
    fit.resize(fit.size() - 2);
    fit[5] = "whole";
    REQUIRE(folder.run(fit).exit_code == 0);
    CHECK(comparable(folder, "parts/fit.json") == comparable(folder, "whole/fit.json"));
  }
}

TEST_CASE("resume: a stopped fit keeps every start that had ended, however fast they were",
          "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  REQUIRE(folder
              .run({"fit", "twin/campaign.toml", "--starts", "400", "--out", "out",
                    "--max-evaluations", "600", "--threads", "1", "--quiet"})
              .exit_code == 4);
  const auto fit = nlohmann::json::parse(folder.read("out/fit.json"));
  const auto kept = nlohmann::json::parse(folder.read("out/checkpoint.json"));
  REQUIRE(fit["starts"].size() > 10);
  CHECK(kept["starts"].size() + 1 == fit["starts"].size());  // all but the one that was stopped
}

TEST_CASE("resume: a fit that was stopped in its bootstrap keeps what it had drawn", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  CommandFolder::Arguments fit{
      "fit",     "twin/campaign.toml", "--bootstrap", "1000", "--out", "parts",
      "--quiet", "--max-evaluations",  "500"};
  REQUIRE(folder.run(fit).exit_code == 4);
  CHECK_THAT(folder.read("parts/fit.json"), Contains("\"stopped_in\": \"bootstrap\""));
  CHECK(folder.has("parts/checkpoint.tasks"));
  fit.back() = "1000000";
  fit[6] = "--resume";  // instead of --quiet
  const Outcome resumed = folder.run(fit);
  REQUIRE(resumed.exit_code == 0);
  CHECK_THAT(resumed.err, !Contains("starts from the beginning"));
  fit[6] = "--quiet";
  fit[5] = "whole";
  REQUIRE(folder.run(fit).exit_code == 0);
  CHECK(comparable(folder, "parts/fit.json") == comparable(folder, "whole/fit.json"));
  CHECK_FALSE(folder.has("parts/checkpoint.tasks"));
}

TEST_CASE("resume: a fit that was killed in what it makes beside the search loses none of it",
          "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  const CommandFolder::Arguments whole{
      "fit",        "twin/campaign.toml", "--bootstrap", kSanitized ? "200" : "3000",
      "--profiles", "--cross-validate",   "--out",       "whole",
      "--quiet"};
  REQUIRE(folder.run(whole).exit_code == 0);
  CHECK_FALSE(folder.has("whole/checkpoint.tasks"));
  CommandFolder::Arguments parts = whole;
  parts[7] = "parts";
  std::size_t kept = 0;
  int killed = 0;
  for (int i = 0; i < 3; ++i) {
    killed += folder.run_and_kill(parts, "parts/checkpoint.tasks", "0").exit_code == -SIGKILL;
    if (parts.back() != "--resume") parts.push_back("--resume");
    if (!folder.has("parts/checkpoint.tasks")) break;  // the fit was too fast to be killed
    const std::size_t bytes = folder.read("parts/checkpoint.tasks").size();
    CHECK(bytes >= kept);
    kept = bytes;
  }
  CHECK(killed >= 1);
  SECTION("as it was left") {}
  SECTION("its last entry half written") {
    if (kept > 40)
      folder.write("parts/checkpoint.tasks",
                   folder.read("parts/checkpoint.tasks").substr(0, kept - 30));
  }
  SECTION("one byte of it damaged") {
    std::string text = folder.read("parts/checkpoint.tasks");
    if (kept > 400) text[400] = static_cast<char>(text[400] ^ 1);
    folder.write("parts/checkpoint.tasks", text);
  }
  REQUIRE(folder.run(parts).exit_code == 0);
  CHECK(comparable(folder, "parts/fit.json") == comparable(folder, "whole/fit.json"));
  CHECK_FALSE(folder.has("parts/checkpoint.tasks"));
}

TEST_CASE("resume: chains of a posterior that were killed go on to the same draws",
          "[apps][long]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  const CommandFolder::Arguments whole{
      "fit", "twin/campaign.toml", "--posterior", "600", "--out", "whole", "--quiet", "--threads",
      "1"};
  REQUIRE(folder.run(whole).exit_code == 0);
  CommandFolder::Arguments parts = whole;
  parts[5] = "parts";
  parts.back() = "2";
  int killed = 0;
  for (int i = 0; i < 2; ++i) {
    killed += folder.run_and_kill(parts, "parts/checkpoint.tasks", "0").exit_code == -SIGKILL;
    if (parts.back() != "--resume") parts.push_back("--resume");
  }
  CHECK(killed >= 1);
  REQUIRE(folder.run(parts).exit_code == 0);
  CHECK(comparable(folder, "parts/fit.json") == comparable(folder, "whole/fit.json"));
  CHECK(folder.read("parts/posterior.csv") == folder.read("whole/posterior.csv"));
  CHECK_FALSE(folder.has("parts/checkpoint.tasks"));
}

TEST_CASE("resume: a fit with nothing to go on from says so", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_quick_twin(folder).exit_code == 0);
  CommandFolder::Arguments fit{"fit", "twin/campaign.toml", "--out", "one", "--resume"};
  const Outcome single = folder.run(fit);
  REQUIRE(single.exit_code == 0);
  CHECK_THAT(single.err, Contains("no checkpoint in one") && Contains("one start writes none") &&
                             Contains("starts from the beginning"));
  fit.insert(fit.end(), {"--starts", "2"});
  const Outcome several = folder.run(fit);
  REQUIRE(several.exit_code == 0);
  CHECK_THAT(several.err, Contains("no checkpoint in one:"));
}

}  // namespace rigcal::test
