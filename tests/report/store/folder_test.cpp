#include "report/store/folder.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "common/error.hpp"
#include "tests/support/command.hpp"

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;
using Catch::EndsWith;

TEST_CASE("HeldFolder: leaves no trace", "[report]") {
  const test::CommandFolder folder;
  {
    const HeldFolder held(folder.work() / "a" / "b");
    CHECK(std::filesystem::is_empty(folder.work() / "a" / "b"));
  }
  CHECK(std::filesystem::is_empty(folder.work()));
  { const HeldFolder held(folder.work()); }
  CHECK(std::filesystem::is_empty(folder.work()));
  {
    const HeldFolder held(folder.work() / "a" / "b");
    folder.write("a/result", "x");
  }
  CHECK(folder.read("a/result") == "x");
  CHECK_FALSE(folder.has("a/b"));
}

TEST_CASE("HeldFolder: what it made goes when a signal ends the process", "[report]") {
  const test::CommandFolder folder;
  const auto out = folder.work() / "a" / "b";
  {
    const HeldFolder held(out);
    HeldFolder::remove_if_empty();
    CHECK_FALSE(folder.has("a"));
  }
  const HeldFolder held(out);
  folder.write("a/b/result", "kept");
  HeldFolder::remove_if_empty();
  CHECK(folder.has("a/b/result"));
}

TEST_CASE("HeldFolder: for one at a time", "[report]") {
  const test::CommandFolder folder;
  const auto out = folder.work() / "out";
  {
    const HeldFolder held(out);
    CHECK_THROWS_AS(HeldFolder(out), UsageError);
    CHECK_THROWS_WITH(HeldFolder(out), Contains("out: another run of rigcal writes into it"));
    const HeldFolder other(folder.work() / "other");
  }
  const HeldFolder again(out);
}

TEST_CASE("HeldFolder: names what is in the way", "[report]") {
  const test::CommandFolder folder;
  folder.write("file", "content");
  CHECK_THROWS_AS(HeldFolder(folder.work() / "file"), WriteError);
  CHECK_THROWS_WITH(HeldFolder(folder.work() / "file"),
                    EndsWith("file: is a file; expected a folder"));
  CHECK_THROWS_WITH(HeldFolder(folder.work() / "file" / "below"), Contains("file"));
  CHECK(folder.read("file") == "content");
}

TEST_CASE("write_results: all or none", "[report]") {
  const test::CommandFolder folder;
  folder.write("first", "old");
  std::filesystem::create_directory(folder.work() / "second");
  CHECK_THROWS_AS(write_results(folder.work(), {{"first", "new"}, {"second", "new"}}, {}),
                  WriteError);
  CHECK(folder.read("first") == "old");
  CHECK(folder.files() == std::set<std::string>{"first"});
}

TEST_CASE("write_results: never over an input, and then nothing", "[report]") {
  const test::CommandFolder folder;
  folder.write("run.csv", "record");
  const std::vector<InputFile> inputs{{(folder.work() / "run.csv").string(), ""}};
  CHECK_THROWS_AS(write_results(folder.work(), {{"other.csv", "x"}, {"run.csv", "y"}}, inputs),
                  UsageError);
  CHECK(folder.files() == std::set<std::string>{"run.csv"});
  CHECK(folder.read("run.csv") == "record");
  write_results(folder.work(), {{"sub/other.csv", "x"}}, inputs);
  CHECK(folder.read("sub/other.csv") == "x");
}
