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

// A signal handler can access only globals.
std::atomic<bool> interrupted{false};
std::atomic<int> keeping{0};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

/// Must not lock or allocate: the signal may have come in the middle of either.
[[noreturn]] void end_at_once() {
  constexpr std::string_view kWords = "rigcal: stopped by a signal before its end\n";
  FilesInWriting::remove_all();
  report::HeldFolder::remove_if_empty();
  if (::write(STDERR_FILENO, kWords.data(), kWords.size()) < 0) {
    // The error cannot be reported any more.
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
  // A limit of the size of files is an error of writing, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  return interrupted;
}

Kept::Kept() { ++keeping; }

Kept::~Kept() { --keeping; }

}  // namespace rigcal::app
