#pragma once

#include <atomic>

namespace rigcal::app {

/// Lets SIGINT and SIGTERM end the run. If there is nothing worth keeping they end the process at
/// once, with exit code `stopped`. While a Kept lives, the first signal sets the returned flag and
/// a second one ends the process. Writing beyond a limit of file sizes fails without ending the
/// process.
const std::atomic<bool>& watch_signals();

/// While an object lives, a signal does not discard the work: the work checks the flag, and its
/// results are written.
class Kept {
 public:
  Kept();
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept();
};

}  // namespace rigcal::app
