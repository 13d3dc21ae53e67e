#include "report/folder.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "common/error.hpp"
#include "tests/support/command.hpp"

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;

TEST_CASE("require_writable: leaves no trace", "[report]") {
  const test::CommandFolder folder;
  require_writable(folder.work() / "a" / "b");
  CHECK(std::filesystem::is_empty(folder.work()));
  require_writable(folder.work());
  CHECK(std::filesystem::is_empty(folder.work()));
}

TEST_CASE("require_writable: names what is in the way", "[report]") {
  const test::CommandFolder folder;
  folder.write("file", "content");
  CHECK_THROWS_AS(require_writable(folder.work() / "file"), WriteError);
  CHECK_THROWS_WITH(require_writable(folder.work() / "file" / "below"), Contains("file"));
  CHECK(folder.read("file") == "content");
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
