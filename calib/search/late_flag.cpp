#include "calib/search/late_flag.hpp"

#include <chrono>
#include <system_error>

namespace rigcal::calib {
namespace {

constexpr std::chrono::milliseconds kLook{10};  ///< interval at which the stop flag is read

}  // namespace

LateFlag::LateFlag(const std::atomic<bool>* first, double grace_s) : flag_(first) {
  if (first == nullptr || !(grace_s > 0.0)) return;
  try {
    waiting_ = std::thread([this, first, grace_s] { follow(*first, grace_s); });
    flag_ = &late_;
  } catch (const std::system_error&) {
    // Without a thread to wait with, the stop flag acts at once.
  }
}

LateFlag::~LateFlag() {
  if (!waiting_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    done_ = true;
  }
  over_.notify_one();
  waiting_.join();
}

void LateFlag::follow(const std::atomic<bool>& first, double grace_s) {
  std::unique_lock lock(mutex_);
  const auto done = [this] { return done_; };
  while (!first.load(std::memory_order_relaxed)) {
    if (over_.wait_for(lock, kLook, done)) return;
  }
  if (!over_.wait_for(lock, std::chrono::duration<double>(grace_s), done)) late_ = true;
}

}  // namespace rigcal::calib
