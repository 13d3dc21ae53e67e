#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/file.hpp"
#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/schema.hpp"

// A user's files in a folder that results are written to.

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string kManifest = "out/rigcal-manifest.json";

/// A verb and one of the files that it writes.
struct Verb {
  CommandFolder::Arguments arguments;
  std::string file;
};

const std::string kPublishedTables = R"([leak_table]
targets = [10]
[leak_table.assumptions]
kp = { value = "1000 V/m", source = "a guess", fit = true, start = "700 V/m", lower = "100 V/m", upper = "5000 V/m" }
[[leak_table.signal]]
waveform = "sine"
frequency = "2 Hz"
amplitude = "5 mm"
printed = ["C10"]
)";

const std::string kShortDesign = R"([design]
stroke = ["-6 mm", "8 mm"]
duration = "1 s"
sample_rate = "100 Hz"
family = "multisine"
evaluations = 4
)";

const std::vector<Verb> kVerbs{
    {{"average", "twin/campaign.toml"}, "averaged/sine.csv"},
    {{"simulate", "twin/campaign.toml"}, "sine.csv"},
    {{"fit", "twin/campaign.toml"}, "fitted.toml"},
    {{"validate", "twin/campaign.toml", "--fit", "one/fit.json"}, "residuals/sine.csv"},
    {{"leak-table", "twin/campaign.toml", "--targets", "10", "--signals", "sine@2Hz@5mm"},
     "leak_table.csv"},
    {{"fit-tables", "tables.toml"}, "parameters.csv"},
    {{"diagnose", "twin/campaign.toml", "--fit", "one/fit.json"}, "diagnosis.csv"},
    {{"parity", "twin/campaign.toml", "--fit", "one/fit.json"}, "parity.csv"},
    {{"plan", "twin/campaign.toml"}, "plan.json"},
    {{"plan", "twin/designed.toml", "--design", "damping,valve_gain"}, "design.csv"},
    {{"explore", "twin/campaign.toml"}, "explore.html"},
    {{"export", "fmu", "twin/campaign.toml"}, "small_rig_synthetic.fmu"},
    {{"synthesize", "truth.toml", "--seed", "3"}, "records/sine_r1.csv"},
    {{"init", "twin/records/sine_r1.csv"}, "campaign.toml"},
    {{"batch", "lab"}, "batch.csv"},
    {{"compare", "one", "two"}, "comparison.json"},
};

/// Returns the verbs of this build: without the compiler for live pages there is no `explore`.
std::vector<Verb> verbs(const CommandFolder& folder) {
  std::vector<Verb> result = kVerbs;
  if (folder.run({"--version"}).out.find("no live pages") != std::string::npos)
    std::erase_if(result, [](const Verb& each) { return each.arguments[0] == "explore"; });
  return result;
}

/// Prepares a rig with records, two fits, and a folder of rigs.
void prepare(const CommandFolder& folder) {
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder
              .run({"leak-table", "truth.toml", "--targets", "10", "--signals", "sine@2Hz@5mm",
                    "--out", "tables", "--quiet"})
              .exit_code == 0);
  const json table = json::parse(folder.read("tables/leak_table.json"));
  const double coefficient = table["entries"][0]["coefficients"][0];
  folder.write("tables.toml",
               kCampaign + edited(kPublishedTables, {{"C10", std::to_string(coefficient)}}));
  folder.write("twin/designed.toml", kCampaign + kSynthetic + kShortDesign);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "one", "--quiet"}).exit_code == 0);
  REQUIRE(folder.run({"validate", "twin/campaign.toml", "--out", "two", "--quiet"}).exit_code < 2);
  std::filesystem::create_directories(folder.work() / "lab");
  std::filesystem::copy(folder.work() / "twin", folder.work() / "lab" / "bench",
                        std::filesystem::copy_options::recursive);
}

Outcome run(const CommandFolder& folder, const Verb& verb,
            const CommandFolder::Arguments& more = {}) {
  CommandFolder::Arguments arguments = verb.arguments;
  arguments.insert(arguments.end(), {"--out", "out"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return folder.run(arguments);
}

std::map<std::string, std::string> content(const CommandFolder& folder, const std::string& where) {
  std::map<std::string, std::string> texts;
  for (const std::string& name : folder.files())
    if (name.starts_with(where + "/")) texts[name] = folder.read(name);
  return texts;
}

/// Expects exit code 2, a message about `file`, and unchanged files.
void check_kept(const CommandFolder& folder, const Verb& verb, const std::string& words) {
  const auto before = content(folder, "out");
  const Outcome outcome = run(folder, verb);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains(words) && Contains("--force"));
  CHECK(content(folder, "out") == before);
}

}  // namespace

TEST_CASE("user files: no verb replaces what it has not written, but for --force", "[apps]") {
  const CommandFolder folder;
  prepare(folder);
  for (const Verb& verb : verbs(folder)) {
    CAPTURE(verb.arguments);
    const std::string file = "out/" + verb.file;
    std::filesystem::remove_all(folder.work() / "out");
    folder.write(file, "precious measurement");
    folder.write("out/notes.txt", "beside");
    check_kept(folder, verb, verb.file + ": not written by rigcal");

    const Outcome forced = run(folder, verb, {"--force"});
    CAPTURE(forced.err);
    CHECK((forced.exit_code < 2 || forced.exit_code == 3));
    CHECK(folder.read(file) != "precious measurement");
    CHECK(folder.read("out/notes.txt") == "beside");
    const json manifest = json::parse(folder.read(kManifest));
    CHECK(violations(manifest, "rigcal-manifest") == "");
    bool listed = false;
    for (const json& each : manifest["files"]) {
      CHECK(each["verb"] == verb.arguments[0]);
      const std::string path = "out/" + each["path"].get<std::string>();
      CHECK(each["sha256"] == rigcal::sha256_of_file(folder.work() / path));
      listed = listed || path == file;
    }
    CHECK(listed);

    // The verb replaces its own results, but not those that were changed.
    CHECK(run(folder, verb).exit_code == forced.exit_code);
    folder.write(file, folder.read(file) + " ");
    check_kept(folder, verb, verb.file + ": changed since rigcal wrote it");
    CHECK(run(folder, verb, {"--force"}).exit_code == forced.exit_code);

    // Without a manifest, as in results from earlier versions. A draft is kept, because users edit
    // it, and so is a page of `explore`, which no version without a manifest wrote.
    std::filesystem::remove(folder.work() / kManifest);
    if (verb.arguments[0] == "init") {
      check_kept(folder, verb, "campaign.toml, campaign.schema.json: not written by rigcal");
    } else if (verb.arguments[0] == "explore") {
      check_kept(folder, verb, "explore.html: not written by rigcal");
    } else {
      CHECK(run(folder, verb).exit_code == forced.exit_code);
    }
  }
}

TEST_CASE("user files: report keeps a page that was changed, and figures of others", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "out", "--quiet"}).exit_code == 0);
  REQUIRE(folder.run({"report", "out", "--figures"}).exit_code == 0);
  REQUIRE(folder.run({"report", "out", "--figures"}).exit_code == 0);
  std::string figure;
  for (const std::string& name : folder.files())
    if (name.starts_with("out/figures/")) figure = name;
  for (const std::string& file : {std::string("out/report.html"), figure}) {
    const std::string drawn = folder.read(file);
    folder.write(file, "mine");
    const Outcome refused = folder.run({"report", "out", "--figures"});
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, Contains(file.substr(4) + ": changed since"));
    CHECK(folder.read(file) == "mine");
    REQUIRE(folder.run({"report", "out", "--figures", "--force"}).exit_code == 0);
    CHECK(folder.read(file) == drawn);
  }
  std::filesystem::remove(folder.work() / kManifest);
  CHECK(folder.run({"report", "out", "--figures"}).exit_code == 0);
}

TEST_CASE("user files: several verbs share a folder, again and again", "[apps]") {
  const CommandFolder folder;
  folder.write("truth.toml", kCampaign + kSynthetic);
  for (int i = 0; i < 2; ++i) {
    REQUIRE(folder.run({"synthesize", "truth.toml", "--seed", "1", "--out", "demo"}).exit_code ==
            0);
    REQUIRE(folder.run({"average", "demo/campaign.toml", "--out", "demo"}).exit_code == 0);
    REQUIRE(folder.run({"fit", "demo/campaign.toml", "--out", "demo"}).exit_code == 0);
    REQUIRE(folder
                .run({"validate", "demo/campaign.toml", "--fit", "demo/fit.json", "--out",
                      "demo/validation"})
                .exit_code == 0);
    std::filesystem::copy_file(folder.work() / "demo/validation/validation.json",
                               folder.work() / "demo/validation.json",
                               std::filesystem::copy_options::overwrite_existing);
  }
  // Only a validation would replace the copy, and it treats the copy as a foreign file.
  const Outcome outcome = folder.run({"validate", "demo/campaign.toml", "--out", "demo"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("validation.json: not written by rigcal"));
}

TEST_CASE("user files: what a campaign has no more goes, what was edited stays", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const CommandFolder::Arguments fit{"fit", "twin/campaign.toml", "--out", "out", "--quiet"};
  REQUIRE(folder.run(fit).exit_code == 0);
  REQUIRE(folder.has("out/residuals/square.csv"));
  const std::string campaign = folder.read("twin/campaign.toml");
  std::string without = campaign;
  const std::size_t at = without.find("use = \"validate\"");
  REQUIRE(at != std::string::npos);
  folder.write("twin/campaign.toml", without.replace(at, 16, "use = \"ignore\""));
  REQUIRE(folder.run(fit).exit_code == 0);
  CHECK_FALSE(folder.has("out/residuals/square.csv"));
  folder.write("twin/campaign.toml", campaign);
  REQUIRE(folder.run(fit).exit_code == 0);
  folder.write("out/residuals/square.csv", "edited");
  folder.write("twin/campaign.toml", without);
  REQUIRE(folder.run(fit).exit_code == 0);
  CHECK(folder.read("out/residuals/square.csv") == "edited");
}

TEST_CASE("user files: a checkpoint of somebody else is neither replaced nor cut", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  for (const char* name : {"out/checkpoint.json", "out/checkpoint.tasks"}) {
    std::filesystem::remove_all(folder.work() / "out");
    folder.write(name, "of a neural network");
    for (const bool resume : {false, true}) {
      CommandFolder::Arguments fit{"fit", "twin/campaign.toml", "--out", "out", "--starts", "2"};
      if (resume) fit.emplace_back("--resume");
      CHECK(folder.run(fit).exit_code == 2);
      CHECK(folder.read(name) == "of a neural network");
    }
  }
}

TEST_CASE("user files: batch hands --force on, and a rig alone is refused without it", "[apps]") {
  const CommandFolder folder;
  prepare(folder);
  folder.write("out/bench/fit.json", "mine");
  const Outcome refused = folder.run({"batch", "lab", "--out", "out"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("fit.json: not written by rigcal"));
  CHECK(folder.read("out/bench/fit.json") == "mine");
  CHECK(folder.has("out/batch.json"));
  CHECK(folder.run({"batch", "lab", "--out", "out", "--force"}).exit_code == 0);
  CHECK(json::parse(folder.read("out/bench/fit.json"))["schema"] == "rigcal.fit/2");
}

TEST_CASE("user files: no verb follows a link inside its folder of results", "[apps]") {
  const CommandFolder folder;
  prepare(folder);
  for (const Verb& verb : verbs(folder)) {
    CAPTURE(verb.arguments);
    const std::filesystem::path file = verb.file;
    const std::string name = file.filename().string();
    const std::string link = verb.arguments[0] == "batch" ? "bench" : file.parent_path().string();
    std::filesystem::remove_all(folder.work() / "out");
    std::filesystem::remove_all(folder.work() / "elsewhere");
    folder.write("elsewhere/" + name, "mine");
    std::filesystem::create_directories(folder.work() / "out");
    const auto elsewhere = content(folder, "elsewhere");
    if (!link.empty()) {
      std::filesystem::create_directory_symlink("../elsewhere", folder.work() / "out" / link);
      for (const char* option : {"--quiet", "--force"}) {
        const Outcome outcome = run(folder, verb, {option});
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK_THAT(outcome.err, Contains("out/" + link + ": is a link"));
      }
      CHECK(content(folder, "out").empty());
    } else {
      std::filesystem::create_symlink("../elsewhere/" + name, folder.work() / "out" / name);
      check_kept(folder, verb, name + ": not written by rigcal");
      const Outcome forced = run(folder, verb, {"--force"});
      CHECK((forced.exit_code < 2 || forced.exit_code == 3));
      CHECK_FALSE(std::filesystem::is_symlink(folder.work() / "out" / name));
      CHECK(folder.has("out/" + name));
    }
    CHECK(content(folder, "elsewhere") == elsewhere);
  }
}

TEST_CASE("user files: links inside a folder of results are not followed", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  folder.write("elsewhere/sine.csv", "mine");
  std::filesystem::create_directories(folder.work() / "real");
  std::filesystem::create_directory_symlink("real", folder.work() / "out");
  std::filesystem::create_directory_symlink("../elsewhere", folder.work() / "real/residuals");
  for (const char* option : {"--quiet", "--force"}) {
    const Outcome outcome = folder.run({"fit", "twin/campaign.toml", "--out", "out", option});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("out/residuals: is a link"));
  }
  CHECK(folder.read("elsewhere/sine.csv") == "mine");
  std::filesystem::remove(folder.work() / "real/residuals");
  CHECK(folder.run({"fit", "twin/campaign.toml", "--out", "out"}).exit_code == 0);
  CHECK(folder.has("real/residuals/sine.csv"));
}
