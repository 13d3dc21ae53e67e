#include "common/uninterrupted.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <optional>

using rigcal::Uninterrupted;

namespace {

volatile std::sig_atomic_t postponed_count = 0;

extern "C" void end_unless_postponed(int signal) {
  if (!Uninterrupted::postpones(signal)) ::_exit(postponed_count);
  postponed_count = postponed_count + 1;
}

/// Runs `work` in a child process and returns the exit code; 99 if the work is completed.
template <typename Work>
int exit_code_of(Work work) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGUSR1, end_unless_postponed);
    work();
    ::_exit(99);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("Uninterrupted: a signal waits for the last one", "[common]") {
  CHECK(exit_code_of([] { std::raise(SIGUSR1); }) == 0);
  CHECK(exit_code_of([] {
          std::optional<Uninterrupted> first;
          first.emplace();
          const Uninterrupted second;
          std::raise(SIGUSR1);
          first.reset();
          std::raise(SIGUSR1);
        }) == 2);
  CHECK(exit_code_of([] { const Uninterrupted alone; }) == 99);
}
