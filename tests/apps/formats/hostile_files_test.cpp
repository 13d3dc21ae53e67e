#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/cli_fixture.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using Catch::StartsWith;
using Arguments = CommandFolder::Arguments;

/// Replaces a file with something else.
struct Damage {
  std::string name;
  std::function<void(const fs::path&)> put;
  std::string word;  ///< word that the message must contain
};

const std::vector<Damage> kNoFiles{
    {"a pipe", [](const fs::path& at) { REQUIRE(::mkfifo(at.c_str(), 0600) == 0); }, "regular"},
    {"a device", [](const fs::path& at) { fs::create_symlink("/dev/zero", at); }, "regular"},
    {"a folder", [](const fs::path& at) { fs::create_directory(at); }, "folder"},
};

/// Checks for exit code 2 and one line that names the file and does not blame a bug.
void check_no_input(const CommandFolder& folder, const Arguments& arguments,
                    const std::string& file, const std::string& word) {
  std::string command = "rigcal";
  for (const std::string& argument : arguments) command += " " + argument;
  const Outcome outcome = folder.run(arguments);
  CAPTURE(command, outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, StartsWith("rigcal: ") && Contains(file) && Contains(word) &&
                              !Contains("bug") && !Contains("memory"));
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

void put_in_place(const CommandFolder& folder, const std::string& file, const Damage& damage) {
  fs::remove_all(folder.work() / file);
  damage.put(folder.work() / file);
}

/// Writes a twin and its fit to `fit/`.
void write_fitted_twin(const CommandFolder& folder) {
  REQUIRE(write_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
}

/// Every command that reads fit.json, here with the one in `bad/`.
const std::vector<Arguments> kReadersOfFit{
    {"validate", "twin/campaign.toml", "--fit", "bad/fit.json", "--out", "v"},
    {"report", "bad"},
    {"compare", "fit", "bad", "--out", "c"}};

}  // namespace

TEST_CASE("hostile files: a pipe, device or folder is no input", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  for (const Damage& damage : kNoFiles) {
    CAPTURE(damage.name);
    fs::remove_all(folder.work() / "bad");
    fs::copy(folder.work() / "fit", folder.work() / "bad");
    put_in_place(folder, "bad/fit.json", damage);
    for (const Arguments& reader : kReadersOfFit)
      check_no_input(folder, reader, "bad/fit.json", damage.word);
    put_in_place(folder, "no.toml", damage);
    check_no_input(folder, {"check", "no.toml"}, "no.toml", damage.word);
    fs::remove_all(folder.work() / "bad");
    fs::copy(folder.work() / "fit", folder.work() / "bad");
    put_in_place(folder, "bad/checkpoint.json", damage);
    check_no_input(folder, {"fit", "twin/campaign.toml", "--resume", "--out", "bad", "--quiet"},
                   "bad", "checkpoint.json");
    for (const std::string kind : {"csv", "mat", "h5", "xlsx"}) {
      if (damage.name != "a folder") {  // `init` may read a folder
        put_in_place(folder, "no." + kind, damage);
        check_no_input(folder, {"init", "no." + kind, "--out", "i"}, "no." + kind, damage.word);
      }
      folder.write("twin/" + kind + ".toml",
                   replaced(folder.read("twin/campaign.toml"), "records/sine_r1.csv",
                            "records/sine_bad." + kind));
      put_in_place(folder, "twin/records/sine_bad." + kind, damage);
      check_no_input(folder, {"check", "twin/" + kind + ".toml"}, "sine_bad." + kind,
                     "no file matches");
    }
  }
}

TEST_CASE("hostile files: a result that exhausts stack, memory or time is refused", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  const std::string whole = folder.read("fit/fit.json");
  const auto cost = nlohmann::json::parse(whole).at("cost").dump();
  std::string keys = "{";
  for (int i = 0; i < 100'000; ++i) keys += "\"k" + std::to_string(i) + "\": 1,\n";
  keys += "\"schema\": \"rigcal.fit/1\"}";
  const std::string nested = std::string(300'000, '[') + std::string(300'000, ']');
  struct Case {
    std::string content, place, word;
  };
  const std::vector<Case> cases{
      {"{\"schema\": " + nested + "}", "bad/fit.json:1:75: ", "more than 64 deep"},
      {replaced(whole, "\"converged\"", nested), "bad/fit.json:2:", "more than 64 deep"},
      {keys, "bad/fit.json:", "keys"},
      {replaced(whole, "\"cost\": " + cost, "\"cost\": 1e999"), "bad/fit.json:", "1e999"},
      {replaced(whole, "\"cost\": " + cost, "\"cost\": nan"), "bad/fit.json:", "not JSON"},
      {"", "bad/fit.json:1:1: ", "not JSON"},
  };
  for (const Case& each : cases) {
    folder.write("bad/fit.json", each.content);
    for (const Arguments& reader : kReadersOfFit)
      check_no_input(folder, reader, each.place, each.word);
  }
  fs::resize_file(folder.work() / "bad/fit.json", std::uintmax_t{3} << 30);  // a sparse file
  for (const Arguments& reader : kReadersOfFit)
    check_no_input(folder, reader, "bad/fit.json", "at most 128 MB");
}

TEST_CASE("hostile files: a result of unheard-of numbers is no bug", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  const std::string whole = folder.read("fit/fit.json");
  // A number beyond the limit is rejected at its position, before its key is known.
  for (const auto& [rank, named] : {std::pair("1e308", "number 1e308"), std::pair("-3", "'rank'"),
                                    std::pair("0.5", "'rank'")}) {
    folder.write("bad/fit.json", replaced(whole, "\"rank\": 2", std::string("\"rank\": ") + rank));
    check_no_input(folder, {"compare", "fit", "bad", "--out", "c"}, "bad/fit.json", named);
  }
  folder.write("bad/fit.json", replaced(whole, "\"conditions\": [", "\"conditions\": [7,"));
  check_no_input(folder, {"compare", "fit", "bad", "--out", "c"}, "bad/fit.json",
                 "key 'conditions[0]': found 7, expected an object");
  folder.write("bad/fit.json", replaced(whole, "\"key\": \"damping\"", "\"key\": 0.5"));
  check_no_input(folder, {"compare", "fit", "bad", "--out", "c"}, "bad/fit.json",
                 ".key': found 0.5, expected text");
}

TEST_CASE("hostile files: a table of a result that is cut short", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  folder.write("fit/residuals/sine.csv", "time_s");
  check_no_input(folder, {"report", "fit"}, "sine.csv",
                 "is not the file that fit.json was written with");
  folder.write("fit/residuals/sine.csv", "time_s,x\n1,");
  check_no_input(folder, {"report", "fit"}, "sine.csv",
                 "is not the file that fit.json was written with");
}

TEST_CASE("rigcal: an empty path is refused", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string campaign = "twin/campaign.toml";
  for (const Arguments& arguments : std::vector<Arguments>{{"average", campaign, "--out", ""},
                                                           {"simulate", campaign, "--out", ""},
                                                           {"fit", campaign, "--out", ""},
                                                           {"validate", campaign, "--out", ""},
                                                           {"plan", campaign, "--out", ""},
                                                           {"leak-table", campaign, "--out", ""},
                                                           {"init", "twin/records", "--out", ""}})
    check_no_input(folder, arguments, "--out", "empty path");
  check_no_input(folder, {"validate", campaign, "--fit", ""}, "--fit", "empty path");
  check_no_input(folder, {"check", campaign, "--data", ""}, "--data", "empty path");
  check_no_input(folder, {"check", ""}, "CAMPAIGN", "empty path");
}

TEST_CASE("rigcal: numbers of the command line that are none", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string campaign = "twin/campaign.toml";
  check_no_input(folder, {"fit", campaign, "--max-time", "nan"}, "--max-time", "nan");
  check_no_input(folder, {"fit", campaign, "--max-evaluations", "1e20"}, "--max-evaluations",
                 "expected a whole number");
  check_no_input(folder, {"fit", campaign, "--max-evaluations", "99999999999999999999"},
                 "--max-evaluations", "expected a whole number");
  check_no_input(folder, {"synthesize", campaign, "--seed", "18446744073709551616"}, "--seed",
                 "expected a whole number");
  check_no_input(folder, {"fit", campaign, "--seed", "-1"}, "--seed", "expected a whole number");
}

TEST_CASE("rigcal: a limit of the size of files is an error of writing", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  const std::string before = folder.read("fit/fit.json");
  const std::string scorecard = folder.read("fit/scorecard.csv");
  rlimit unlimited{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &unlimited) == 0);
  rlimit small = unlimited;
  small.rlim_cur = 8192;  // smaller than fit.json, but larger than the output of the command
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  const Outcome outcome =
      folder.run({"fit", "twin/campaign.toml", "--seed", "7", "--out", "fit", "--quiet"});
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &unlimited) == 0);
  CHECK(outcome.exit_code == 5);
  CHECK_THAT(outcome.err, StartsWith("rigcal: fit/") && Contains("cannot be written"));
  CHECK(folder.read("fit/fit.json") == before);
  CHECK(folder.read("fit/scorecard.csv") == scorecard);
}

TEST_CASE("rigcal: two runs into one folder", "[apps]") {
  const CommandFolder folder;
  write_fitted_twin(folder);
  // A run locks its folder in this way until it ends.
  const int other = ::open((folder.work() / "fit").c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(::flock(other, LOCK_EX | LOCK_NB) == 0);
  const std::string before = folder.read("fit/fit.json");
  for (const char* verb : {"fit", "validate", "average", "simulate", "plan"})
    check_no_input(folder, {verb, "twin/campaign.toml", "--out", "fit"},
                   "fit: ", "another run of rigcal");
  CHECK(folder.read("fit/fit.json") == before);
  CHECK(folder.run({"plan", "twin/campaign.toml", "--out", "other", "--quiet"}).exit_code == 0);
  ::close(other);
  CHECK(folder.run({"plan", "twin/campaign.toml", "--out", "fit", "--quiet"}).exit_code == 0);
}

}  // namespace rigcal::test
