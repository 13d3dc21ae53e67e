#include "common/confined.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "common/parallel.hpp"
#include "tests/support/sanitized.hpp"

using Catch::Contains;
using rigcal::ConfinedFailure;
using rigcal::Confinement;
using rigcal::run_confined;

TEST_CASE("confined: the text comes back, whatever its size", "[common]") {
  CHECK(run_confined([] { return std::string(); }, {}).empty());
  CHECK(run_confined([] { return std::string("a\0b", 3); }, {}) == std::string("a\0b", 3));
  const std::string large(10'000'000, 'x');  // more than a pipe holds
  CHECK(run_confined([&] { return large; }, {}) == large);
}

TEST_CASE("confined: nothing of it stays behind", "[common]") {
  int changed = 0;
  run_confined(
      [&] {
        changed = 1;
        std::puts("not seen");
        return std::string();
      },
      {});
  CHECK(changed == 0);
}

TEST_CASE("confined: a crash ends the child alone", "[common]") {
  for (const int signal : {SIGSEGV, SIGABRT}) {
    const auto crash = [signal] {
      std::signal(signal, SIG_DFL);  // a sanitizer would report it
      std::raise(signal);
      return std::string("not reached");
    };
    CHECK_THROWS_WITH(run_confined(crash, {}), Contains("it crashed"));
  }
  CHECK_THROWS_AS(run_confined([]() -> std::string { ::_exit(3); }, {}), ConfinedFailure);
}

TEST_CASE("confined: what never ends is ended", "[common]") {
  Confinement short_time;
  short_time.cpu_seconds = 1;
  const auto spin = [] {
    for (volatile int i = 0;; i = i + 1) {
    }
    return std::string();
  };
  CHECK_THROWS_WITH(run_confined(spin, short_time), Contains("it took more than 1 s"));
  short_time.wall_seconds = 1;
  const auto wait = [] {
    for (;;) ::pause();
    return std::string();
  };
  CHECK_THROWS_WITH(run_confined(wait, short_time), Contains("it took more than 1 s"));
}

TEST_CASE("confined: memory is limited", "[common]") {
  if (rigcal::test::kSanitized) return;  // AddressSanitizer needs terabytes of addresses
  Confinement small;
  small.bytes = std::size_t{32} << 20;
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      char* const memory = static_cast<char*>(std::malloc(bytes));
      if (memory == nullptr) std::abort();
      for (std::size_t i = 0; i < bytes; i += 4096) memory[i] = 1;
      return std::string(1, memory[0]);
    };
  };
  CHECK_NOTHROW(run_confined(take(std::size_t{16} << 20), small));
  CHECK_THROWS_WITH(run_confined(take(std::size_t{64} << 20), small),
                    Contains("more than 32 MB of memory"));
}

TEST_CASE("confined: from several threads at a time", "[common]") {
  std::vector<std::string> results(40);
  rigcal::parallel_for(results.size(), 4, [&](std::size_t i) {
    results[i] = run_confined([i] { return std::to_string(i); }, {});
  });
  for (std::size_t i = 0; i < results.size(); ++i) CHECK(results[i] == std::to_string(i));
}
