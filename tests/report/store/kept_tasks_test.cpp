#include "report/store/kept_tasks.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "tests/support/temporary_folder.hpp"

using rigcal::FarmJob;
using rigcal::TaskResult;
using rigcal::ThreadFarm;
using rigcal::report::KeptTasks;
using rigcal::report::Provenance;
using rigcal::test::TemporaryFolder;
using rigcal::test::text_of;

namespace {

/// Runs a job with ten tasks; every third task is interrupted.
struct Made {
  std::size_t found = 0;
  int calls = 0;
  std::vector<TaskResult> results;
};

Made run(const std::filesystem::path& file, const Provenance& provenance, bool resume,
         const std::string& state = "state", bool whole = false) {
  ThreadFarm farm;
  KeptTasks tasks(farm, file, provenance, resume);
  Made made;
  made.found = tasks.found();
  std::atomic<int> calls = 0;
  made.results = tasks.run({"job", state, 10, 2},
                           [&](std::size_t i) -> TaskResult {
                             ++calls;
                             return {"result " + std::to_string(i), whole || i % 3 != 0};
                           },
                           {});
  made.calls = calls;
  return made;
}

}  // namespace

TEST_CASE("kept tasks: what is whole is not made again", "[report]") {
  const TemporaryFolder folder;
  const auto file = folder / "checkpoint.tasks";
  Provenance provenance;
  provenance.seed = 7;
  CHECK(run(file, provenance, false).calls == 10);
  const Made again = run(file, provenance, true, "state", true);
  CHECK(again.found == 6);
  CHECK(again.calls == 4);  // tasks 0, 3, 6 and 9 were interrupted
  REQUIRE(again.results.size() == 10);
  for (std::size_t i = 0; i < 10; ++i)
    CHECK(again.results[i].bytes == "result " + std::to_string(i));
  CHECK(run(file, provenance, true).calls == 0);

  SECTION("another state, another fit, or a new beginning knows nothing") {
    CHECK(run(file, provenance, true, "other").calls == 10);
    provenance.seed = 8;
    CHECK(run(file, provenance, true).calls == 10);
    provenance.seed = 7;
    CHECK(run(file, provenance, true).calls == 0);
    CHECK(run(file, provenance, false).calls == 10);
  }
  SECTION("an entry that is damaged, and what follows it, is made again") {
    const std::string text = text_of(file);
    for (const std::size_t at : {std::size_t{3}, text.size() / 2, text.size() - 1}) {
      std::string damaged = text;
      damaged[at] = static_cast<char>(damaged[at] ^ 4);
      std::ofstream(file, std::ios::binary) << damaged;
      const Made made = run(file, provenance, true, "state", true);
      CHECK(made.found < 10);
      CHECK(made.calls == 10 - static_cast<int>(made.found));
      CHECK(run(file, provenance, true).calls == 0);
    }
  }
  SECTION("nothing but the begin of an entry") {
    std::ofstream(file, std::ios::binary) << "ffffffffffffffff";
    CHECK(run(file, provenance, true).calls == 10);
  }
}

TEST_CASE("kept tasks: a result that cannot be kept is an error", "[report]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(run(folder / "nowhere" / "checkpoint.tasks", {}, false), rigcal::WriteError);
}
