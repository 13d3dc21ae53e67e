#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "report/batch/batch_rigs.hpp"

namespace rigcal::app {

/// Runs `rigcal` with these arguments in a child process and waits for it, so that a crash or lack
/// of memory there does not end this process. Only the error message of its output is kept. The
/// child is not an MPI process, even if this one is. It gets SIGTERM when `cancel` becomes true or
/// this process ends. Thread-safe. If no process can be started the result is ExitCode::internal
/// with the reason.
report::VerbEnd run_child(const std::vector<std::string>& arguments,
                          const std::atomic<bool>& cancel);

}  // namespace rigcal::app
