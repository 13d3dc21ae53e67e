#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/mat/load_mat.hpp"
#include "tests/datasets/mat_fixture.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;

TEST_CASE("load_mat: a huge file is refused within 200 MB", "[datasets]") {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("rigcal-huge-" + std::to_string(::getpid()) + ".mat");
  // 13 million zeros take 104 MB, but compressed only 0.1 MB on disk.
  write_mat(path, MatFormat::v7, {mat_array("x", std::vector<double>(13'000'000))});
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  const long megabytes_before = pages * ::sysconf(_SC_PAGESIZE) / (1 << 20);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    try {
      load_mat_record(path, {{"x"}, ""});
    } catch (const rigcal::InputError& error) {
      const std::string message = error.what();
      ::_exit(message.find("12000000, the limit of one file") == message.npos ? 3 : 2);
    }
    ::_exit(0);
  }
  int status = 0;
  rusage usage{};
  REQUIRE(::wait4(child, &status, 0, &usage) == child);
  CHECK(WEXITSTATUS(status) == 2);
  std::filesystem::remove(path);
  CHECK(usage.ru_maxrss / 1024 - megabytes_before < 200);
}
