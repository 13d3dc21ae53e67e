#pragma once

#include <atomic>

namespace rigcal::app {

/// Installs handlers for SIGINT and SIGTERM. If there is nothing worth keeping, a signal ends the
/// process at once with exit code `stopped`. While a Kept object exists, the first signal sets the
/// returned flag and the second ends the process. Exceeding the file size limit makes a write fail
/// but does not end the process.
const std::atomic<bool>& watch_signals();

/// Protects the results of a computation from signals. While an object exists, the first signal
/// does not end the process. The computation must check the flag and write the results it has so
/// far.
class Kept {
 public:
  Kept();
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept();
};

}  // namespace rigcal::app
