#include "apps/rigcal/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

#include "common/error.hpp"
#include "common/file.hpp"
#include "common/uninterrupted.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

// These are globals, because a signal handler cannot access anything else.
std::atomic<bool> interrupted{false};
std::atomic<int> keeping{0};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

/// Ends the process. It must not lock or allocate, because the signal may have interrupted code
/// that was doing so.
[[noreturn]] void end_at_once() {
  constexpr std::string_view kWords = "rigcal: stopped by a signal before it had finished\n";
  FilesInWriting::remove_all();
  report::HeldFolder::remove_if_empty();
  if (::write(STDERR_FILENO, kWords.data(), kWords.size()) < 0) {
    // The process is ending, so this error cannot be reported.
  }
  ::_exit(static_cast<int>(ExitCode::stopped));
}

extern "C" void on_signal(int signal) {
  if (keeping > 0) {
    interrupted = true;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    return;
  }
  if (!Uninterrupted::postpones(signal)) end_at_once();
}

}  // namespace

const std::atomic<bool>& watch_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // Exceeding the file size limit should be a write error, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  return interrupted;
}

Kept::Kept() { ++keeping; }

Kept::~Kept() { --keeping; }

}  // namespace rigcal::app
