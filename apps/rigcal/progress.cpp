#include "apps/rigcal/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace rigcal::app {

Progress::Progress(bool quiet, std::string work)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), work_(std::move(work)) {}

Progress::~Progress() {
  if (line_is_open_) std::fputs("\n", stderr);
}

void Progress::operator()(int start, int iteration, double cost, double relative_change,
                          double seconds) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  const auto pause = std::chrono::milliseconds(line_is_open_ ? 100 : 1000);
  if (now - last_shown_ < pause) return;
  last_shown_ = now;
  const std::string change =
      std::isfinite(relative_change) ? fmt::format("{:.1e}", relative_change) : "-";
  const std::string line =
      fmt::format("{}, iteration {}: cost {:.6g}, change {}, {:.1f} s",
                  fmt::format(fmt::runtime(work_), start), iteration, cost, change, seconds);
  if (terminal_) {
    std::fputs(fmt::format("\r\x1b[K{}", line).c_str(), stderr);
    line_is_open_ = true;
  } else {
    std::fputs((line + "\n").c_str(), stderr);
  }
  std::fflush(stderr);
}

}  // namespace rigcal::app
