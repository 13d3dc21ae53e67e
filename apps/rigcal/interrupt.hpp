#pragma once

#include <atomic>

namespace rigcal::app {

/// Lets SIGINT and SIGTERM end the run. Where nothing of it is worth keeping they end the process
/// at once, exit code `stopped`, wherever it is; while a Kept lives, the first one sets the flag
/// that is returned and a second one ends the process. Writing beyond a limit of the size of files
/// fails, and ends nothing by itself.
const std::atomic<bool>& watch_signals();

/// While one lives, what the run has reached is kept when a signal ends it: the work looks at the
/// flag, and its results are written.
class Kept {
 public:
  Kept();
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept();
};

}  // namespace rigcal::app
