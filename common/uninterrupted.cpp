#include "common/uninterrupted.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

namespace rigcal {
namespace {

// A signal handler can access only globals.
std::atomic<int> uninterrupted{0};
std::atomic<int> postponed{0};
std::atomic<bool> ending{false};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not lock");

}  // namespace

Uninterrupted::Uninterrupted() {
  // The order matters: either the handler counts this object, or this loop sees that it is ending.
  ++uninterrupted;
  while (ending) {
    --uninterrupted;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++uninterrupted;
  }
}

Uninterrupted::~Uninterrupted() {
  if (--uninterrupted > 0) return;
  if (const int signal = postponed.exchange(0)) std::raise(signal);
}

bool Uninterrupted::any() { return uninterrupted > 0; }

bool Uninterrupted::postpones(int signal) {
  postponed = signal;
  ending = true;
  if (uninterrupted == 0) return false;
  ending = false;
  return true;
}

}  // namespace rigcal
