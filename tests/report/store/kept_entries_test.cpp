#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "report/store/kept_tasks.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests which task results are written and which are read back.

using rigcal::FarmJob;
using rigcal::TaskResult;
using rigcal::ThreadFarm;
using rigcal::report::KeptTasks;
using rigcal::report::Provenance;
using rigcal::test::TemporaryFolder;
using rigcal::test::text_of;

namespace {

Provenance seeded(unsigned long seed) {
  Provenance provenance;
  provenance.seed = seed;
  return provenance;
}

/// The tasks that were computed, and the bytes reported for each task.
struct Run {
  std::size_t found = 0;
  std::set<std::size_t> made;
  std::map<std::size_t, std::string> told;
  std::vector<TaskResult> results;
};

Run run_kept(const std::filesystem::path& file, const FarmJob& job, bool resume = true,
             const std::string& prefix = "result ", std::size_t cut_short = 99) {
  ThreadFarm farm;
  KeptTasks tasks(farm, file, seeded(7), resume);
  Run run;
  run.found = tasks.found();
  run.results = tasks.run(
      job,
      [&](std::size_t i) -> TaskResult {
        run.made.insert(i);
        return {prefix + std::to_string(i), i != cut_short};
      },
      [&](std::size_t i, const TaskResult& result) { run.told[i] = result.bytes; });
  return run;
}

const FarmJob kJob{"profiles", "state", 3, 1, {}};
const std::set<std::size_t> kAll{0, 1, 2};

/// Returns the start of each entry, which begins with its length in sixteen digits.
std::vector<std::size_t> begins(const std::string& text) {
  std::vector<std::size_t> list;
  for (std::size_t at = 0; at < text.size();) {
    list.push_back(at);
    at += 16 + 64 + std::stoul(text.substr(at, 16), nullptr, 16);
  }
  return list;
}

}  // namespace

TEST_CASE("kept tasks: each result is told, known or not, and kept once", "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  const Run first = run_kept(file, kJob);
  CHECK(first.found == 0);
  CHECK(first.made == kAll);
  CHECK(first.told.at(2) == "result 2");
  const std::string text = text_of(file);
  CHECK(begins(text).size() == 3);
  const Run again = run_kept(file, kJob, true, "another ");
  CHECK(again.found == 3);
  CHECK(again.made.empty());
  CHECK(again.told == first.told);
  CHECK(again.results.at(1).bytes == "result 1");
  CHECK(again.results.at(1).whole);
  CHECK(text_of(file) == text);
}

TEST_CASE("kept tasks: what was cut short is not kept", "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  CHECK(run_kept(file, kJob, true, "short ", 1).results.at(1).bytes == "short 1");
  CHECK(begins(text_of(file)).size() == 2);
  const Run again = run_kept(file, kJob);
  CHECK(again.found == 2);
  CHECK(again.made == std::set<std::size_t>{1});
  CHECK(again.results.at(0).bytes == "short 0");
  CHECK(again.results.at(1).bytes == "result 1");
}

TEST_CASE("kept tasks: a result belongs to its job by name, state, number of tasks and fit",
          "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  run_kept(file, kJob);
  CHECK(run_kept(file, {"folds", "state", 3, 1, {}}).made == kAll);
  CHECK(run_kept(file, {"profiles", "other", 3, 1, {}}).made == kAll);
  CHECK(run_kept(file, {"profiles", "state", 4, 1, {}}).made.size() == 4);
  CHECK(run_kept(file, {"profiles", "state", 3, 2, {}}).made.empty());  // lanes have no effect
  CHECK(run_kept(file, kJob).made.empty());
  ThreadFarm farm;
  KeptTasks other(farm, file, seeded(8), true);
  CHECK(other.found() == 13);
  int made = 0;
  other.run(kJob, [&](std::size_t) -> TaskResult { return {std::to_string(++made), true}; }, {});
  CHECK(made == 3);
}

TEST_CASE("kept tasks: a damaged entry and all behind it are made again, those before it are not",
          "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  run_kept(file, kJob);
  const std::string text = text_of(file);
  const auto at = begins(text);
  REQUIRE(at.size() == 3);
  const auto found_in = [&](const std::string& damaged) {
    std::ofstream(file, std::ios::binary) << damaged;
    const Run result = run_kept(file, kJob, true, "again ");
    CHECK(result.made.size() == 3 - result.found);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(result.results.at(i).bytes ==
            (i < result.found ? "result " : "again ") + std::to_string(i));
    CHECK(run_kept(file, kJob).made.empty());  // the file is complete again
    CHECK(begins(text_of(file)).size() == 3);
    return result.found;
  };
  CHECK(found_in(text) == 3);
  CHECK(found_in("") == 0);
  for (std::size_t entry = 0; entry < 3; ++entry) {
    CAPTURE(entry);
    // Damages a digit of the length, of the hash and of the content, and truncates within each of
    // them.
    for (const std::size_t place :
         {std::size_t{15}, std::size_t{16}, std::size_t{79}, std::size_t{80}, std::size_t{95}}) {
      CAPTURE(place);
      std::string damaged = text;
      char& c = damaged[at[entry] + place];
      c = static_cast<char>(c ^ 1);
      CHECK(found_in(damaged) == entry);
      CHECK(found_in(text.substr(0, at[entry] + place)) == entry);
    }
    CHECK(found_in(text.substr(0, at[entry])) == entry);
    CHECK(found_in(text.substr(0, at[entry] + 1)) == entry);
  }
  std::string large = text;
  for (int i = 0; i < 16; ++i) large[at[1] + static_cast<std::size_t>(i)] = 'f';
  CHECK(found_in(large) == 1);
  std::string upper = text;
  upper.replace(at[1], 16, "00000000000000FF");
  CHECK(found_in(upper) == 1);
  CHECK(found_in(text + "rest of an entry") == 3);
}

TEST_CASE("kept tasks: bytes are bytes", "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  const std::string bytes("\0\n\r\xff\0", 5);
  run_kept(file, {"profiles", "state", 1, 1, {}}, true, bytes);
  CHECK(run_kept(file, {"profiles", "state", 1, 1, {}}).results.at(0).bytes == bytes + "0");
}

TEST_CASE("kept tasks: a new beginning removes what there is, and so does the end", "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  run_kept(file, kJob);
  ThreadFarm farm;
  {
    const KeptTasks anew(farm, file, seeded(7), false);
    CHECK(anew.found() == 0);
    CHECK_FALSE(std::filesystem::exists(file));
  }
  CHECK(run_kept(file, kJob, false).made == kAll);
  KeptTasks tasks(farm, file, seeded(7), true);
  CHECK(tasks.found() == 3);
  CHECK(tasks.rank() == 0);
  CHECK(tasks.processes() == 1);
  tasks.remove();
  CHECK_FALSE(std::filesystem::exists(file));
}
