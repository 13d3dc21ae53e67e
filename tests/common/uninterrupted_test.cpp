#include "common/uninterrupted.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <optional>

using rigcal::Uninterrupted;

namespace {

volatile std::sig_atomic_t ended = 0;

extern "C" void end_unless_postponed(int signal) {
  if (!Uninterrupted::postpones(signal)) ended = ended + 1;
}

}  // namespace

TEST_CASE("Uninterrupted: a signal waits for the last one", "[common]") {
  ended = 0;
  const auto before = std::signal(SIGUSR1, end_unless_postponed);
  std::raise(SIGUSR1);
  CHECK(ended == 1);
  {
    std::optional<Uninterrupted> first;
    first.emplace();
    const Uninterrupted second;
    std::raise(SIGUSR1);
    first.reset();
    CHECK(ended == 1);
  }
  CHECK(ended == 2);
  { const Uninterrupted later; }
  CHECK(ended == 2);  // it came once
  std::signal(SIGUSR1, before);
}
