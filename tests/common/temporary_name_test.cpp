#include "common/temporary_name.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "common/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal {
namespace {

TEST_CASE("remove_left_behind: a file of a process that is no more goes, all others stay",
          "[common]") {
  const test::TemporaryFolder folder;
  constexpr int kNoProcess = 2'147'483'646;
  const std::string dead = fmt::format(".fit.json.{}.0.tmp", kNoProcess);
  const std::string living = fmt::format(".fit.json.{}.0.tmp", ::getppid());
  // Left by an earlier process with the same ID.
  const std::string own = fmt::format(".fit.json.{}.0.tmp", ::getpid());
  const std::string foreign = fmt::format(".notes.txt.{}.0.tmp", kNoProcess);
  for (const std::string& name : {dead, living, own, foreign})
    write_file_atomically(folder.path() / name, "text");
  remove_left_behind(folder.path(), {"fit.json"});
  CHECK_FALSE(std::filesystem::exists(folder.path() / dead));
  CHECK_FALSE(std::filesystem::exists(folder.path() / own));
  CHECK(std::filesystem::exists(folder.path() / living));
  CHECK(std::filesystem::exists(folder.path() / foreign));
}

}  // namespace
}  // namespace rigcal
