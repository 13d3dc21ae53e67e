#include "common/uninterrupted.hpp"

#include <atomic>
#include <csignal>

namespace rigcal {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<int> uninterrupted{0};
std::atomic<int> postponed{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not lock");

}  // namespace

Uninterrupted::Uninterrupted() { ++uninterrupted; }

Uninterrupted::~Uninterrupted() {
  if (--uninterrupted > 0) return;
  if (const int signal = postponed.exchange(0)) std::raise(signal);
}

bool Uninterrupted::postpones(int signal) {
  // In this order: what ends meanwhile either finds the signal, or is no longer counted.
  postponed = signal;
  if (uninterrupted > 0) return true;
  postponed = 0;
  return false;
}

}  // namespace rigcal
