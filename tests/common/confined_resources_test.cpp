#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "common/confined.hpp"
#include "tests/support/sanitized.hpp"

using Catch::Contains;
using rigcal::Confinement;
using rigcal::NoResources;
using rigcal::run_confined;

namespace {

/// Lowers a limit of this process during the lifetime of the object.
class LowerLimit {
 public:
  LowerLimit(decltype(RLIMIT_AS) resource, rlim_t most) : resource_(resource) {
    ::getrlimit(resource_, &before_);
    const rlimit lower{most, before_.rlim_max};
    REQUIRE(::setrlimit(resource_, &lower) == 0);
  }
  LowerLimit(const LowerLimit&) = delete;
  LowerLimit& operator=(const LowerLimit&) = delete;
  ~LowerLimit() { ::setrlimit(resource_, &before_); }

 private:
  decltype(RLIMIT_AS) resource_;
  rlimit before_{};
};

}  // namespace

TEST_CASE("confined: a process that cannot be made is no fault of the work", "[common]") {
  std::exception_ptr thrown;
  {  // in a short scope, because sanitizers need to open files
    const LowerLimit files(RLIMIT_NOFILE, 0);
    try {
      run_confined([] { return std::string("never"); }, {});
    } catch (...) {
      thrown = std::current_exception();
    }
  }
  REQUIRE(thrown != nullptr);
  try {
    std::rethrow_exception(thrown);
  } catch (const NoResources& error) {
    CHECK(error.code() == rigcal::ExitCode::internal);
    CHECK_THAT(error.what(), Contains("cannot start a process") && Contains("try again"));
  }
}

TEST_CASE("confined: what the system ends is no fault of the work", "[common]") {
  const auto ended = []() -> std::string {
    ::raise(SIGKILL);
    return {};
  };
  CHECK_THROWS_AS(run_confined(ended, {}), NoResources);
}

TEST_CASE("confined: a lower limit of memory is no fault of the work", "[common]") {
  if (rigcal::test::kSanitized) return;  // AddressSanitizer needs terabytes of address space
  const auto take = []() -> std::string {
    if (std::malloc(std::size_t{256} << 20) == nullptr) std::abort();
    return "got it";
  };
  CHECK(run_confined(take, {}) == "got it");
  CHECK_FALSE(Confinement().memory_is_short());
  rlim_t pages = 0;
  {
    std::FILE* const file = std::fopen("/proc/self/statm", "r");
    REQUIRE(file != nullptr);
    unsigned long read = 0;
    REQUIRE(std::fscanf(file, "%lu", &read) == 1);
    std::fclose(file);
    pages = read;
  }
  const LowerLimit memory(
      RLIMIT_AS, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{64} << 20));
  CHECK(Confinement().memory_is_short());
  CHECK_THROWS_AS(run_confined(take, {}), NoResources);
}

TEST_CASE("confined: time by the size of the file", "[common]") {
  constexpr std::uintmax_t kMB = 1 << 20;
  CHECK(Confinement::of_file(0).cpu_seconds == 4);
  CHECK(Confinement::of_file(9'700).cpu_seconds == 4);
  CHECK(Confinement::of_file(100 * kMB).cpu_seconds == 204);
  CHECK(Confinement::of_file(100 * kMB).wall_seconds >= 2040);
  CHECK(Confinement::of_file(0).wall_seconds >= 60);
  CHECK(Confinement::of_file(~std::uintmax_t{0}).cpu_seconds == 2004);
}
