#include "apps/rigcal/interrupt.hpp"

#include <csignal>

#include "common/error.hpp"

namespace rigcal::app {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

extern "C" void on_signal(int) {
  interrupted.store(true);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& watch_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A limit of the size of files is an error of writing, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  return interrupted;
}

void stop_if(const std::atomic<bool>& cancel) {
  if (cancel.load()) {
    throw Error(ExitCode::stopped,
                "stopped by a signal before there was a result; nothing written");
  }
}

}  // namespace rigcal::app
