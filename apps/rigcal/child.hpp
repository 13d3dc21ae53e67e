#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace rigcal::app {

/// How a child process of this program ended.
struct ChildEnd {
  ExitCode code = ExitCode::internal;
  std::string error;  ///< its last error message, on one line; empty if there was none
  double seconds = 0.0;
};

/// Runs `rigcal` with these arguments in a child process, so that a crash or lack of memory there
/// does not end this one, and waits for it. Of its output only the error message is kept. It is not
/// an MPI process, even if this one is. It gets SIGTERM when `cancel` becomes true or this process
/// ends. Thread-safe. Where no process can be started it ends with ExitCode::internal and says why.
ChildEnd run_child(const std::vector<std::string>& arguments, const std::atomic<bool>& cancel);

}  // namespace rigcal::app
