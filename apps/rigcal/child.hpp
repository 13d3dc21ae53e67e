#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace rigcal::app {

/// End of a child process of this program.
struct ChildEnd {
  ExitCode code = ExitCode::internal;
  std::string error;  ///< its last error message, on one line; empty if there was none
  double seconds = 0.0;
};

/// Runs `rigcal` with these arguments in a child process and waits for it, so that a crash or lack
/// of memory there does not end this process. Only the error message of its output is kept. The
/// child is not an MPI process, even if this one is. It gets SIGTERM when `cancel` becomes true or
/// this process ends. Thread-safe. If no process can be started the result is ExitCode::internal
/// with the reason.
ChildEnd run_child(const std::vector<std::string>& arguments, const std::atomic<bool>& cancel);

}  // namespace rigcal::app
