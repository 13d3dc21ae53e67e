#include "common/confined.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
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
  const std::string large(10'000'000, 'x');  // larger than the buffer of a pipe
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

TEST_CASE("confined: what the work prints is dropped", "[common]") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  std::fflush(stdout);
  const int terminal = ::dup(STDOUT_FILENO);
  ::dup2(ends[1], STDOUT_FILENO);
  ::close(ends[1]);
  const std::string text = run_confined(
      [] { return std::string(::write(STDOUT_FILENO, "seen", 4) == 4 ? "y" : "n"); }, {});
  ::dup2(terminal, STDOUT_FILENO);
  ::close(terminal);
  CHECK(text == "y");
  char byte = 0;
  CHECK(::read(ends[0], &byte, 1) == 0);
  ::close(ends[0]);
}

TEST_CASE("confined: a crash ends the child alone", "[common]") {
  for (const int signal : {SIGSEGV, SIGABRT}) {
    const auto crash = [signal] {
      std::signal(signal, SIG_DFL);  // otherwise a sanitizer would report it
      std::raise(signal);
      return std::string("not reached");
    };
    CHECK_THROWS_WITH(run_confined(crash, {}), Contains("it crashed"));
  }
  CHECK_THROWS_AS(run_confined([]() -> std::string { ::_exit(3); }, {}), ConfinedFailure);
}

TEST_CASE("confined: what the work throws unwinds nothing of the parent", "[common]") {
  // In shared memory, so that changes made by the child are visible here.
  auto* const unwound = static_cast<std::atomic<int>*>(
      ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  REQUIRE(unwound != MAP_FAILED);
  struct Witness {
    std::atomic<int>& count;
    ~Witness() { ++count; }
  };
  const auto parent_frame = [&](const std::function<std::string()>& work) {
    const Witness witness{*unwound};
    return run_confined(work, {});
  };
  CHECK_THROWS_WITH(parent_frame([]() -> std::string { throw std::length_error("too long"); }),
                    Contains("it crashed"));
  CHECK(*unwound == 1);  // in the parent only
  const auto before = std::set_new_handler([] { ::_exit(0); });
  CHECK(run_confined([] { return std::get_new_handler() == nullptr ? "none" : "the parent's"; },
                     {}) == "none");
  std::set_new_handler(before);
  ::munmap(unwound, 4096);
}

TEST_CASE("confined: what never ends is ended", "[common]") {
  Confinement short_time;
  short_time.cpu_seconds = 1;
  const auto spin = [] {
    std::atomic<int> turns = 0;
    for (;;) ++turns;
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

TEST_CASE("confined: what ends the process ends the work", "[common]") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t process = ::fork();
  if (process == 0) {
    const auto wait = [&]() -> std::string {
      if (::write(ends[1], "x", 1) != 1) ::_exit(1);
      for (;;) ::pause();
    };
    try {
      run_confined(wait, {});
    } catch (const ConfinedFailure&) {
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  char byte = 0;
  CHECK(::read(ends[0], &byte, 1) == 1);
  ::kill(process, SIGKILL);
  ::waitpid(process, nullptr, 0);
  // The last process that had the other end of the pipe open has ended.
  pollfd closed{ends[0], POLLIN, 0};
  REQUIRE(::poll(&closed, 1, 60'000) == 1);
  CHECK(::read(ends[0], &byte, 1) == 0);
  ::close(ends[0]);
}

TEST_CASE("confined: memory is limited", "[common]") {
  if (rigcal::test::kSanitized) return;  // AddressSanitizer needs terabytes of address space
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
