#include "datasets/read/confined_read.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/confined.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::datasets {
namespace {

constexpr ConfinedReader kAnyReader{"a library", "a file", "expected another file"};

/// Returns the limit of CPU time of this process.
double cpu_limit_s() {
  rlimit now{};
  REQUIRE(::getrlimit(RLIMIT_CPU, &now) == 0);
  return static_cast<double>(now.rlim_cur);
}

}  // namespace

TEST_CASE("confined read: a reader has time by the size of its file", "[datasets]") {
  const test::TemporaryFolder folder;
  for (const std::uintmax_t bytes : {std::uintmax_t{9'700}, std::uintmax_t{50} << 20}) {
    folder.write("record.h5", "a record");
    const std::filesystem::path file = folder / "record.h5";
    std::filesystem::resize_file(file, bytes);
    const auto expected = static_cast<double>(Confinement::of_file(bytes).cpu_seconds);
    CAPTURE(bytes, expected);
    const RecordTable table = load_confined(file, kAnyReader, 1, [] {
      RecordTable read;
      read.columns = {{cpu_limit_s()}};
      return read;
    });
    CHECK(table.columns.at(0).at(0) == expected);
    const auto columns = list_confined(file, kAnyReader, [] {
      return std::vector<RecordColumn>{{std::to_string(cpu_limit_s()), ""}};
    });
    CHECK(columns.at(0).name == std::to_string(expected));
  }
}

}  // namespace rigcal::datasets
