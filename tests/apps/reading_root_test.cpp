#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/apps/cli_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr const char* kSecret = "swordfish:1:2";

/// Writes a campaign to `lab/rig` that reads a file from another folder.
void write_in_lab(const CommandFolder& folder, const std::string& repeats) {
  write_campaign(folder, {{"records/sine_*.csv", repeats}});
  fs::create_directories(folder.work() / "lab/rig");
  fs::rename(folder.work() / "campaign.toml", folder.work() / "lab/rig/campaign.toml");
  fs::rename(folder.work() / "records", folder.work() / "lab/rig/records");
  folder.write("secret.txt", std::string(kSecret) + "\n");
}

}  // namespace

TEST_CASE("--root: what a campaign names outside of it is not read", "[apps]") {
  const CommandFolder folder;
  const auto check = [&](const std::string& repeats, const std::string& root) {
    write_in_lab(folder, repeats);
    const Outcome outcome =
        folder.run({"check", "lab/rig/campaign.toml", "--root", root, "--quiet"});
    fs::remove_all(folder.work() / "lab");
    CHECK_THAT(outcome.err, !Contains("swordfish"));
    return outcome;
  };
  CHECK(check("records/sine_*.csv", "lab").exit_code == 0);
  CHECK(check("records/sine_*.csv", "lab/rig/../rig").exit_code == 0);
  for (const std::string& repeats :
       {std::string("../../secret.txt"), (folder.work() / "secret.txt").string(),
        std::string("../../*.txt"), std::string("/*/passwd"), std::string("../../none.csv")}) {
    CAPTURE(repeats);
    const Outcome outcome = check(repeats, "lab");
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("leads out of 'lab', the folder of --root"));
  }
  CHECK_THAT(check("records/sine_*.csv", "lab/rig/records").err,
             Contains("campaign.toml: leads out"));
  CHECK_THAT(check("records/sine_*.csv", "none").err, Contains("none: is not a folder"));
}

TEST_CASE("--root: links are followed before it is decided", "[apps]") {
  const CommandFolder folder;
  write_in_lab(folder, "records/sine_*.csv");
  fs::create_symlink("../../../secret.txt", folder.work() / "lab/rig/records/sine_9.csv");
  const Outcome outcome = folder.run({"check", "lab/rig/campaign.toml", "--root", "lab"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("sine_9.csv: leads out of 'lab'") && !Contains("swordfish"));
  const Outcome data =
      folder.run({"check", "lab/rig/campaign.toml", "--root", "lab", "--data", "."});
  CHECK(data.exit_code == 2);
  CHECK_THAT(data.err, Contains("leads out of 'lab'"));
}

TEST_CASE("--root: neither is what stands beside a campaign", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"use = \"validate\"", "use = \"diagnose\""}}).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "one", "--quiet"}).exit_code == 0);
  const auto diagnose = [&] {
    return folder.run({"diagnose", "twin/campaign.toml", "--fit", "one/fit.json", "--root", "twin",
                       "--out", "out", "--force", "--quiet"});
  };
  CHECK(diagnose().exit_code == 0);
  fs::rename(folder.work() / "twin/truth.json", folder.work() / "truth.json");
  fs::create_symlink("../truth.json", folder.work() / "twin/truth.json");
  const Outcome outcome = diagnose();
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("truth.json: leads out of 'twin'"));
}

TEST_CASE("truth.json: what a link out of the folder leads to is not shown", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder, {{"use = \"validate\"", "use = \"diagnose\""}}).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "one", "--quiet"}).exit_code == 0);
  const auto diagnose = [&] {
    return folder.run({"diagnose", "twin/campaign.toml", "--fit", "one/fit.json", "--out", "out",
                       "--force", "--quiet"});
  };
  folder.write("secret.json", "{\"schema\": \"swordfish\"}");
  fs::rename(folder.work() / "twin/truth.json", folder.work() / "truth.json");
  fs::create_symlink("../secret.json", folder.work() / "twin/truth.json");
  const Outcome hidden = diagnose();
  CHECK(hidden.exit_code == 2);
  CHECK_THAT(hidden.err,
             Contains("twin/truth.json: ") && Contains("is not shown") && !Contains("swordfish"));
  // In the folder of the campaign it is shown, and a link to a true one is followed.
  fs::remove(folder.work() / "twin/truth.json");
  fs::copy_file(folder.work() / "secret.json", folder.work() / "twin/truth.json");
  CHECK_THAT(diagnose().err, Contains("swordfish"));
  fs::remove(folder.work() / "twin/truth.json");
  fs::create_symlink("../truth.json", folder.work() / "twin/truth.json");
  CHECK(diagnose().exit_code == 0);
}

TEST_CASE("--root: batch passes it on to every rig", "[apps]") {
  const CommandFolder folder;
  write_in_lab(folder, "../../secret.txt");
  const Outcome outcome = folder.run({"batch", "lab", "--root", "lab", "--out", "out"});
  CHECK_THAT(outcome.out + outcome.err, Contains("leads out of"));
}

TEST_CASE("records: what stands in files elsewhere is not shown", "[apps]") {
  const CommandFolder folder;
  write_in_lab(folder, "../../secret.txt");
  const Outcome outcome = folder.run({"check", "lab/rig/campaign.toml"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err,
             Contains("secret.txt") && Contains("is not shown") && !Contains("swordfish"));
  // The user of the command may choose this folder with --data.
  const Outcome pointed = folder.run({"check", "lab/rig/campaign.toml", "--data", "lab/rig"});
  CHECK_THAT(pointed.err, !Contains("swordfish"));
  write_campaign(folder, {{"records/sine_*.csv", "secret.txt"}});
  CHECK_THAT(folder.run({"check", "campaign.toml"}).err, Contains("swordfish"));
}
