#include "calib/search/late_flag.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

namespace rigcal::calib {

TEST_CASE("late flag: it follows the stop flag, and only that", "[calib]") {
  std::atomic<bool> stop{false};
  const LateFlag late(&stop, 0.02);
  REQUIRE(late.flag() != nullptr);
  REQUIRE(late.flag() != &stop);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK_FALSE(late.flag()->load());
  stop = true;
  for (int looks = 0; looks < 1000 && !late.flag()->load(); ++looks)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK(late.flag()->load());
}

TEST_CASE("late flag: without a grace it is the stop flag, and without that there is none",
          "[calib]") {
  const std::atomic<bool> stop{false};
  CHECK(LateFlag(&stop, 0.0).flag() == &stop);
  CHECK(LateFlag(nullptr).flag() == nullptr);
  CHECK_FALSE(is_raised(nullptr));
  CHECK_FALSE(is_raised(&stop));
}

TEST_CASE("late flag: it ends before its grace is over", "[calib]") {
  const std::atomic<bool> stop{true};
  // A destructor that waited for the grace would wait for longer than any test may run.
  const LateFlag late(&stop, 1e5);
  CHECK_FALSE(is_raised(late.flag()));
}

}  // namespace rigcal::calib
